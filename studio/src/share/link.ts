/** A whole scene in the fragment of a URL, which no server sees.
 *
 *  `#scene=1.` and, in base64url, compressed by `deflate`, whose checksum tells what was damaged on its way: the length of a head as
 *  four bytes, the head in JSON, and the bytes of the files. */

export interface Shared {
  name: string;
  text: string;
  files?: [string, Uint8Array][];
  /** How it is looked at; whoever wrote it knows what it means. */
  view?: unknown;
}

/** Why a scene has no link, or a link no scene, in words for people. */
export class LinkError extends Error {
  override name = 'LinkError';
}

interface Head {
  name: string;
  text: string;
  files: [name: string, length: number][];
  view?: unknown;
}

const START = '#scene=';
const VERSION = '1';
/** Longer links are cut off on their way, by some programs that send or keep them. */
export const MAX_LINK = 32 * 1024;
/** A small link could become more than the memory holds. Browsers look only after each piece of what they decompress, so that it is
 *  important as well that links are short. */
const MAX_BYTES = 8 * 1024 * 1024;

/** Does this page have an address that others can open? One in a notebook has none. */
export const isLinkable = () => location.protocol !== 'about:';

/** The fragment of a link to a scene. */
export async function encode({ name, text, files = [], view }: Shared): Promise<string> {
  const head: Head = { name, text, files: files.map(([file, bytes]) => [file, bytes.length]), ...(view !== undefined && { view }) };
  const json = new TextEncoder().encode(JSON.stringify(head));
  const length = new Uint8Array(4);
  new DataView(length.buffer).setUint32(0, json.length);
  const parts = [length, json, ...files.map(([, bytes]) => bytes)];
  const total = parts.reduce((sum, part) => sum + part.length, 0);
  if (total > MAX_BYTES) throw tooLarge(total);
  const compressed = await passed(parts, new CompressionStream('deflate'), Infinity);
  const link = `${START}${VERSION}.${base64url(compressed)}`;
  if (link.length > MAX_LINK) throw tooLarge(link.length);
  return link;
}

/** The scene of a fragment; nothing if the fragment means something else. */
export async function decode(fragment: string): Promise<Shared | null> {
  // Some programs encode whatever is not a letter or a number.
  const link = fragment.replace(/^#scene%3D/i, START).replace(/%2E/i, '.');
  if (!link.startsWith(START)) return null;
  if (link.length > MAX_LINK) throw new LinkError(`This link has ${size(link.length)}, and no scene's has more than ${size(MAX_LINK)}.`);
  const [version, ...rest] = link.slice(START.length).split('.');
  if (version !== VERSION && /^\d+$/.test(version!)) {
    throw new LinkError('This link was made by a newer version of Snell Studio, which this one cannot read.');
  }
  const compressed = fromBase64url(rest.join('.'));
  if (version !== VERSION || compressed === null || compressed.length === 0) throw damaged();
  const bytes = await passed([compressed], new DecompressionStream('deflate'), MAX_BYTES).catch((error: unknown) => {
    throw error instanceof LinkError ? error : damaged();
  });
  return sceneOf(bytes);
}

function sceneOf(bytes: Uint8Array): Shared {
  if (bytes.length < 4) throw damaged();
  const headEnd = 4 + new DataView(bytes.buffer, bytes.byteOffset).getUint32(0);
  const head = headOf(bytes.subarray(4, headEnd));
  if (head === null) throw damaged();
  let at = headEnd;
  const files = head.files.map(([name, length]): [string, Uint8Array] => [name, bytes.slice(at, (at += length))]);
  if (at !== bytes.length) throw damaged();
  return { name: head.name, text: head.text, files, ...(head.view !== undefined && { view: head.view }) };
}

function headOf(json: Uint8Array): Head | null {
  try {
    const head = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(json)) as Partial<Head> | null;
    const isFile = (file: unknown) =>
      Array.isArray(file) && file.length === 2 && typeof file[0] === 'string' && Number.isSafeInteger(file[1]) && file[1] >= 0;
    const isHead = typeof head?.name === 'string' && typeof head.text === 'string' && Array.isArray(head.files) && head.files.every(isFile);
    return isHead ? (head as Head) : null;
  } catch {
    return null;
  }
}

/** What comes out of a stream, if it is not too much. */
async function passed(parts: Uint8Array[], stream: CompressionStream | DecompressionStream, most: number): Promise<Uint8Array> {
  const reader = new Blob(parts as BlobPart[]).stream().pipeThrough(stream).getReader();
  const chunks: Uint8Array[] = [];
  let total = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    total += value.length;
    if (total > most) {
      await reader.cancel();
      throw new LinkError(`This link holds more than ${size(most)}, which is more than a scene may have.`);
    }
    chunks.push(value);
  }
  const all = new Uint8Array(total);
  let at = 0;
  for (const chunk of chunks) {
    all.set(chunk, at);
    at += chunk.length;
  }
  return all;
}

function base64url(bytes: Uint8Array): string {
  const binary = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('');
  return btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
}

function fromBase64url(text: string): Uint8Array | null {
  if (!/^[\w-]*$/.test(text)) return null;
  try {
    return Uint8Array.from(atob(text.replaceAll('-', '+').replaceAll('_', '/')), (sign) => sign.charCodeAt(0));
  } catch {
    return null;
  }
}

function tooLarge(length: number): LinkError {
  const message = `With its files this scene is too large for a link: ${size(length)}, where ${size(MAX_LINK)} are sure to arrive.`;
  return new LinkError(`${message} Save it as a file instead, and send that.`);
}

function damaged(): LinkError {
  return new LinkError('This link is damaged: perhaps its end is missing. Ask for it again, or for the scene as a file.');
}

function size(bytes: number): string {
  const [unit, name] = bytes < 1024 * 1024 ? [1024, 'kB'] : [1024 * 1024, 'MB'];
  return `${Math.ceil(bytes / unit)} ${name}`;
}
