/** The scene as something to paste: into a terminal, or into Python. */

export interface Copied {
  /** Its name as a file, or of a built-in scene. */
  name: string;
  /** As TOML; nothing for a built-in scene as it is. */
  text?: string;
  /** Names of the files that it needs. */
  files?: readonly string[];
}

/** For a shell of POSIX. */
export function asCommand({ name, text, files = [] }: Copied): string {
  const picture = quoted(`${stem(name)}.png`);
  if (text === undefined) return `snell render ${quoted(name)} -o ${picture}\n`;
  const lines = withoutReturns(text);
  return `${whereToRun(files)}snell render - -o ${picture} <<'${unused(lines)}'\n${lines}${unused(lines)}\n`;
}

/** For Python 3.11 or newer, as a program or in a notebook. */
export function asPython({ name, text, files = [] }: Copied): string {
  const save = `picture.save(${JSON.stringify(`${stem(name)}.png`)})\n`;
  if (text === undefined) return `import snell\n\npicture = snell.scenes[${JSON.stringify(name)}].render()\n${save}`;
  const scene = `scene = snell.Scene.of(tomllib.loads(${literal(withoutReturns(text))}), name=${JSON.stringify(stem(name))})`;
  return `${whereToRun(files)}import tomllib\n\nimport snell\n\n${scene}\npicture = scene.render()\n${save}`;
}

/** The name of a scene's file without folders and ending: what is made of it is called so. */
export function stem(name: string): string {
  const file = name.split(/[/\\]/).at(-1)!;
  const plain = file.replace(/\.(toml|json|txt|nff)$/i, '').replace(/[\p{Cc}<>:"|?*]/gu, '_');
  return plain.replace(/^[.\s]+|[.\s]+$/g, '') || 'scene';
}

function quoted(word: string): string {
  const safe = word.startsWith('-') ? `./${word}` : word;
  return /^[\w@%+=:,./-]+$/.test(safe) ? safe : `'${safe.replaceAll("'", "'\\''")}'`;
}

function whereToRun(files: readonly string[]): string {
  if (files.length === 0) return '';
  const names = files.slice(0, 3).map((file) => file.replace(/\p{Cc}/gu, ' '));
  const more = files.length > 3 ? ` and ${files.length - 3} more` : '';
  return `# Run it where the files of the scene are: ${names.join(', ')}${more}.\n`;
}

function withoutReturns(text: string): string {
  const lines = text.replace(/^\uFEFF/, '').replace(/\r\n?/g, '\n');
  return lines.endsWith('\n') ? lines : `${lines}\n`;
}

/** A word for the end of a text, which is no line of it. */
function unused(lines: string): string {
  const taken = new Set(lines.split('\n'));
  let word = 'SNELL';
  while (taken.has(word)) word += '_';
  return word;
}

/** A text as a literal of Python, which keeps its lines. */
function literal(lines: string): string {
  const escaped = lines.replaceAll('\\', '\\\\').replaceAll('"""', '\\"\\"\\"');
  return `"""\\\n${escaped}"""`;
}
