/** Files and folders that were dropped or chosen, and which of them is the scene. */

export interface Scene {
  /** With its folders, where it came in one. */
  name: string;
  text: Uint8Array;
  /** The other files, by names like that of the scene. */
  files: [string, Uint8Array][];
}

export type Found =
  | { scene: Scene }
  /** A model without a scene. */
  | { model: string; files: [string, Uint8Array][] }
  /** Which one is meant? Then `choose` it. */
  | { candidates: string[]; files: [string, Uint8Array][] };

/** Why nothing can be opened, in words for people. */
export class DropError extends Error {
  override name = 'DropError';
}

/** What is needed of a `File`. */
export type Readable = Pick<File, 'name' | 'size' | 'arrayBuffer'> & { webkitRelativePath?: string };
type Named = [name: string, file: Readable];

const MAX_BYTES = 1e9;
const MAX_FILES = 20_000;
const MAX_DEPTH = 16;

const SCENES = /\.(toml|json|nff|txt)$/i;
const MODELS = /\.(obj|ply|stl)$/i;
/** What models and scenes name; also pictures that the engine refuses, since it says so better than that they are missing. */
const OTHERS = /\.(mtl|png|ppm|exr|jpe?g|tga|bmp|gif|tiff?|webp|hdr)$/i;
/** What systems put into folders by themselves. */
const HIDDEN = /(^|\/)(\.|__MACOSX\/|node_modules\/)/;

/** What was dropped. To be called while the event is handled: afterwards the browser has forgotten what it was. */
export function dropped(transfer: Pick<DataTransfer, 'items' | 'files'>): Promise<Found> {
  const entries = Array.from(transfer.items).flatMap((item) => item.webkitGetAsEntry?.() ?? []);
  if (entries.length === 0) return chosen(transfer.files);
  return (async () => {
    const all: Named[] = [];
    for (const entry of entries) await collect(entry, all, 0);
    return found(await read(all));
  })();
}

/** What was chosen in an `<input type="file">`, of several files or of a folder. */
export async function chosen(files: Iterable<Readable> | ArrayLike<Readable>): Promise<Found> {
  return found(await read(Array.from(files as ArrayLike<Readable>, (file): Named => [file.webkitRelativePath || file.name, file])));
}

/** One of the candidates. */
export function choose(files: [string, Uint8Array][], name: string): Found {
  const others = files.filter(([other]) => other !== name);
  if (MODELS.test(name)) return { model: name, files };
  return { scene: { name, text: files.find(([other]) => other === name)![1], files: others } };
}

async function collect(entry: FileSystemEntry, all: Named[], depth: number): Promise<void> {
  const name = entry.fullPath.replace(/^\//, '');
  if (HIDDEN.test(`${name}/`)) return;
  if (all.length >= MAX_FILES || depth > MAX_DEPTH) throw tooMany();
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject)).catch(() => {
      throw unreadable(name);
    });
    all.push([name, file]);
  } else {
    for (const inner of await entriesIn(entry as FileSystemDirectoryEntry, name)) await collect(inner, all, depth + 1);
  }
}

/** A folder gives its entries in portions; the last one is empty. */
async function entriesIn(folder: FileSystemDirectoryEntry, name: string): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const all: FileSystemEntry[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject)).catch(() => {
      throw unreadable(name);
    });
    if (some.length === 0) return all;
    all.push(...some);
    if (all.length > MAX_FILES) throw tooMany();
  }
}

/** Reads what a scene can use. */
async function read(all: Named[]): Promise<[string, Uint8Array][]> {
  if (all.length > MAX_FILES) throw tooMany();
  const isLone = all.length === 1;
  const useful = all.filter(([name]) => !HIDDEN.test(name) && (isLone || isUseful(name)));
  // A Mac writes letters and their accents apart; whoever types a name in a scene does not.
  const named = useful.map(([name, file]): Named => [name.normalize('NFC'), file]);
  const total = named.reduce((sum, [, file]) => sum + file.size, 0);
  if (total > MAX_BYTES) {
    const message = `These files have ${Math.round(total / 1e6)} MB, and a browser has room for ${MAX_BYTES / 1e6} MB of them.`;
    throw new DropError(`${message} Leave out what the scene does not need, or render it with the command: snell render.`);
  }
  const names = new Set<string>();
  for (const [name] of named) {
    if (names.has(name)) throw new DropError(`There are two files ${name}: which one the scene means cannot be told.`);
    names.add(name);
  }
  return Promise.all(named.map(async ([name, file]): Promise<[string, Uint8Array]> => {
    const buffer = await file.arrayBuffer().catch(() => {
      throw unreadable(name);
    });
    return [name, new Uint8Array(buffer)];
  }));
}

function isUseful(name: string): boolean {
  return SCENES.test(name) || MODELS.test(name) || OTHERS.test(name) || isDriver(name);
}

/** Drivers are often called so, and nothing else. */
function isDriver(name: string): boolean {
  return /(^|\/)driver[^/.]*$/i.test(name);
}

function found(files: [string, Uint8Array][]): Found {
  const scenes = files.filter(([name, bytes]) => isScene(name, bytes));
  const named = (isMeant: (name: string) => boolean) => files.filter(([name]) => isMeant(name));
  // Of a scene with a mistake the engine says what is wrong; a text beside a model is hardly one.
  const broken = named((name) => /\.toml$/i.test(name) || isDriver(name.replace(/\.txt$/i, '')));
  const models = named((name) => MODELS.test(name));
  const texts = named((name) => SCENES.test(name) || (files.length === 1 && !OTHERS.test(name)));
  const candidates = [scenes, broken, models, texts].find((some) => some.length > 0)?.map(([name]) => name) ?? [];
  if (candidates.length === 0) {
    const kinds = 'A scene is a file .toml, .json or .nff, or a driver .txt; a model .obj, .ply or .stl can be opened alone as well.';
    throw new DropError(`There is no scene among these files. ${kinds}`);
  }
  return candidates.length === 1 ? choose(files, candidates[0]!) : { candidates: candidates.sort(), files };
}

/** Is a file a scene, by its name and by what every scene has? Other files have the same endings: a README.txt, a package.json. */
function isScene(name: string, bytes: Uint8Array): boolean {
  if (/\.nff$/i.test(name)) return true;
  if (!SCENES.test(name) && !isDriver(name)) return false;
  const start = new TextDecoder().decode(bytes.subarray(0, 1 << 20));
  if (/\.toml$/i.test(name)) return /^\s*(snell|"snell"|'snell')\s*=/m.test(start);
  if (/\.json$/i.test(name)) return /"snell"\s*:\s*\d/.test(start);
  return DRIVER_LINES.every((line) => line.test(start));
}

/** A camera, and how large its picture is: in the drivers of every year. */
const DRIVER_LINES = [/^\s*(eye|camera)\s+[-+.\d]/m, /^\s*res\s+\d/m];

function tooMany(): DropError {
  return new DropError(`There are more than ${MAX_FILES} files, or folders deeper than ${MAX_DEPTH}: drop only the scene and what it needs.`);
}

function unreadable(name: string): DropError {
  return new DropError(`The file ${name} cannot be read: perhaps it was moved, or is not yours.`);
}
