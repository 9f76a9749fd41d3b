/** What the engine reports: an error, or a warning, which has a code. */
export interface Finding {
  code?: string;
  message: string;
  help?: string;
  /** Lines and columns count from 1, columns in characters (not in units of UTF-16); the end is behind the last one. */
  place?: { file: string; line: number; column: number; end_line: number; end_column: number };
}
