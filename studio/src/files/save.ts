/** Files and texts that leave the page, by the hand of the person who uses it. */

export function download(name: string, content: BlobPart, type: string): void {
  const url = URL.createObjectURL(new Blob([content], { type }));
  const link = Object.assign(document.createElement('a'), { href: url, download: name });
  link.click();
  // The browser has taken it by then.
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** Rejects where the browser does not allow it. */
export async function copy(text: string): Promise<void> {
  await navigator.clipboard.writeText(text);
}
