/** Undo and redo: all versions of the work, and which of them is shown. */

export interface Version<Base> {
  /** What was opened. */
  base: Base;
  text: string;
  /** What was done to come here, for the buttons: “Undo: move glass”. */
  label: string;
  /** What was being written when it was left, and makes no scene. */
  draft?: string;
}

/** Characters of text that are kept; older versions than that are forgotten. */
const MOST_TEXT = 64e6;

export class History<Base> {
  private versions: Version<Base>[] = [];
  private at = -1;
  /** Of the version that is shown: those that follow under the same name take its place, as a drag makes many. */
  private group: string | null = null;

  get current(): Version<Base> | undefined {
    return this.versions[this.at];
  }

  /** What would be taken back, and what would be done again. */
  get undoLabel(): string | null {
    return this.at > 0 ? this.versions[this.at]!.label : null;
  }

  get redoLabel(): string | null {
    return this.versions[this.at + 1]?.label ?? null;
  }

  /** The version before the one that is shown, or the one after it. */
  peek(steps: -1 | 1): Version<Base> | undefined {
    return this.versions[this.at + steps];
  }

  record(version: Version<Base>, group: string | null = null): void {
    const { current } = this;
    const same = current !== undefined && current.base === version.base && current.text === version.text;
    if (same) return;
    const follows = group !== null && group === this.group && this.at > 0;
    this.versions.length = this.at + (follows ? 0 : 1);
    this.versions.push(version);
    this.group = group;
    this.forgetOld();
    this.at = this.versions.length - 1;
  }

  /** Keeps what is being written with the version that is shown, which is to be left. */
  keepDraft(draft: string | null): void {
    if (this.current && draft !== null) this.current.draft = draft;
  }

  /** Hands out what was being written when the version that is shown was left. */
  takeDraft(): string | null {
    const draft = this.current?.draft ?? null;
    delete this.current?.draft;
    return draft;
  }

  move(steps: -1 | 1): void {
    if (this.peek(steps) === undefined) return;
    this.at += steps;
    this.group = null;
  }

  private forgetOld(): void {
    let kept = 0;
    let first = this.versions.length;
    while (first > 0 && kept <= MOST_TEXT) {
      const { text, draft = '' } = this.versions[--first]!;
      kept += text.length + draft.length;
    }
    // The one that is shown always stays.
    if (kept > MOST_TEXT) this.versions.splice(0, Math.min(first + 1, this.versions.length - 1));
  }
}
