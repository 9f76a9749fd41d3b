/** Looks at the data before anything is drawn, and names the first thing that is wrong. */

import type { RayTreeDocument, ViewerData, ViewScene } from './data';

/** What is wrong with the data, and where. */
export class ViewerDataError extends Error {
  override name = 'ViewerDataError';
}

/** Throws a `ViewerDataError` unless `value` can be shown. */
export function validate(value: unknown): asserts value is ViewerData {
  const data = fields(value, 'data');
  validateScene(data.scene);
  validateTree(data.tree ?? null);
  if (data.title !== undefined) text(data.title, 'title');
  validatePicture(data.picture ?? null);
}

/** Throws a `ViewerDataError` unless `value` is a scene that can be shown. */
export function validateScene(value: unknown): asserts value is ViewScene {
  const scene = fields(value, 'scene');
  version(scene.snell_view, 'scene.snell_view');
  list(scene.spheres, 'scene.spheres', (item, path) => {
    const sphere = surface(item, path);
    triple(sphere.center, `${path}.center`);
    number(sphere.radius, `${path}.radius`);
  });
  list(scene.meshes, 'scene.meshes', (item, path) => {
    const mesh = surface(item, path);
    if (right.get(mesh.vertices as object) === mesh.faces && mesh.faces !== undefined) return;
    const vertices = numbers(mesh.vertices, `${path}.vertices`, Number.isFinite, 'a number') / 3;
    if (!Number.isInteger(vertices)) fail(`${path}.vertices`, 'three numbers for each vertex', mesh.vertices);
    const faces = numbers(mesh.faces, `${path}.faces`, (corner) => isPosition(corner, vertices), positions(vertices));
    if (faces % 3 !== 0) fail(`${path}.faces`, 'three numbers for each face', mesh.faces);
    right.set(mesh.vertices as object, mesh.faces);
  });
  const camera = fields(scene.camera, 'scene.camera');
  triple(camera.eye, 'scene.camera.eye');
  triple(camera.up, 'scene.camera.up');
  list(camera.corners, 'scene.camera.corners', triple);
  if ((camera.corners as unknown[]).length !== 4) fail('scene.camera.corners', 'four points', camera.corners);
  list(scene.lights, 'scene.lights', (item, path) => {
    const light = fields(item, path);
    text(light.name, `${path}.name`);
    triple(light.color, `${path}.color`);
    if (light.position === null) triple(light.direction, `${path}.direction`);
    else triple(light.position, `${path}.position`);
  });
  choice(scene.transfer, TRANSFERS, 'scene.transfer');
}

/** Throws a `ViewerDataError` unless `value` is `null` or a tree that can be shown. */
export function validateTree(value: unknown): asserts value is RayTreeDocument | null {
  optional(checkTree)(value, 'tree');
}

/** Throws a `ViewerDataError` unless `value` is `null` or bytes; whether they are a picture, the browser says later. */
export function validatePicture(value: unknown): asserts value is BufferSource | null {
  const bytes = value === null || value instanceof ArrayBuffer || ArrayBuffer.isView(value);
  if (!bytes) fail('picture', 'the bytes of a PNG', value);
}

type Fields = Record<string, unknown>;
type Check = (value: unknown, path: string) => void;

/** Lists of vertices, with the faces for which they are right: scenes that change keep most of them. */
const right = new WeakMap<object, unknown>();

const TRANSFERS = ['srgb', 'linear'];

function surface(value: unknown, path: string): Fields {
  const object = fields(value, path);
  text(object.name, `${path}.name`);
  triple(object.color, `${path}.color`);
  number(object.opacity, `${path}.opacity`);
  return object;
}

function checkTree(value: unknown): void {
  const tree = fields(value, 'tree');
  version(tree.snell_ray_tree, 'tree.snell_ray_tree');
  for (const key of ['scene', 'integrator', 'sentence']) text(tree[key], `tree.${key}`);
  for (const key of ['pixel', 'size']) {
    list(tree[key], `tree.${key}`, number);
    if ((tree[key] as unknown[]).length !== 2) fail(`tree.${key}`, 'two numbers', tree[key]);
  }
  triple(tree.color, 'tree.color');
  choice(tree.transfer, TRANSFERS, 'tree.transfer');
  number(tree.spp, 'tree.spp');
  list(tree.samples, 'tree.samples', (item, path) => {
    const sample = fields(item, path);
    triple(sample.color, `${path}.color`);
    triple(sample.lost, `${path}.lost`);
    let next = 0;
    list(sample.nodes, `${path}.nodes`, (node, at) => checkNode(node, next++, at));
  });
  if ((tree.samples as unknown[]).length === 0) fail('tree.samples', 'at least one sample', tree.samples);
}

function checkNode(value: unknown, id: number, path: string): void {
  const node = fields(value, path);
  if (node.id !== id) fail(`${path}.id`, `${id}, its place in the list`, node.id);
  if (node.parent !== null) position(node.parent, id, `${path}.parent`);
  choice(node.kind, ['camera', 'mirror', 'refracted', 'inside'], `${path}.kind`);
  text(node.medium, `${path}.medium`);
  for (const key of ['depth', 'eta']) number(node[key], `${path}.${key}`);
  for (const key of ['origin', 'dir', 'throughput', 'contribution', 'subtotal']) triple(node[key], `${path}.${key}`);
  optional(number)(node.band_nm, `${path}.band_nm`);
  optional(triple)(node.bound, `${path}.bound`);
  if (node.ended !== null) choice(node.ended, ['missed', 'depth', 'threshold', 'absorbed', 'rays'], `${path}.ended`);
  optional(checkHit)(node.hit, `${path}.hit`);
  optional(checkLocal)(node.local, `${path}.local`);
}

function checkHit(value: unknown, path: string): void {
  const hit = fields(value, path);
  for (const key of ['object', 'material']) text(hit[key], `${path}.${key}`);
  for (const key of ['primitive', 't', 'angle_in', 'eta_before', 'eta_behind']) number(hit[key], `${path}.${key}`);
  for (const key of ['point', 'normal', 'throughput']) triple(hit[key], `${path}.${key}`);
  optional(number)(hit.angle_out, `${path}.angle_out`);
  flag(hit.total_reflection, `${path}.total_reflection`);
}

function checkLocal(value: unknown, path: string): void {
  const local = fields(value, path);
  triple(local.ambient, `${path}.ambient`);
  triple(local.emission, `${path}.emission`);
  list(local.lights, `${path}.lights`, (item, at) => {
    const light = fields(item, at);
    text(light.name, `${at}.name`);
    for (const key of ['facing', 'at_infinity']) flag(light[key], `${at}.${key}`);
    for (const key of ['transmittance', 'diffuse', 'highlight', 'point']) triple(light[key], `${at}.${key}`);
    optional(text)(light.blocked_by, `${at}.blocked_by`);
    list(light.through, `${at}.through`, text);
    optional(triple)(light.block_point, `${at}.block_point`);
  });
}

function fields(value: unknown, path: string): Fields {
  if (typeof value !== 'object' || value === null || Array.isArray(value)) fail(path, 'an object', value);
  return value as Fields;
}

function list(value: unknown, path: string, check: Check): void {
  if (!Array.isArray(value)) fail(path, 'a list', value);
  value.forEach((item, index) => check(item, `${path}[${index}]`));
}

/** The length of a list of numbers, long or typed: without a path for each of them. */
function numbers(value: unknown, path: string, check: (item: unknown) => boolean, expected: string): number {
  if (!Array.isArray(value) && !(ArrayBuffer.isView(value) && !(value instanceof DataView))) fail(path, 'a list', value);
  const items = value as ArrayLike<unknown>;
  for (let index = 0; index < items.length; index++) if (!check(items[index])) fail(`${path}[${index}]`, expected, items[index]);
  return items.length;
}

function optional(check: Check): Check {
  return (value, path) => value === null || check(value, path);
}

function number(value: unknown, path: string): void {
  if (!Number.isFinite(value)) fail(path, 'a number', value);
}

function text(value: unknown, path: string): void {
  if (typeof value !== 'string') fail(path, 'a text', value);
}

function flag(value: unknown, path: string): void {
  if (typeof value !== 'boolean') fail(path, 'true or false', value);
}

function triple(value: unknown, path: string): void {
  if (!Array.isArray(value) || value.length !== 3 || !value.every(Number.isFinite)) fail(path, 'three numbers', value);
}

function choice(value: unknown, choices: string[], path: string): void {
  if (!choices.includes(value as string)) fail(path, `one of ${choices.join(', ')}`, value);
}

/** A place in a list of which `length` items are known. */
function position(value: unknown, length: number, path: string): void {
  if (!isPosition(value, length)) fail(path, positions(length), value);
}

function isPosition(value: unknown, length: number): boolean {
  return Number.isInteger(value) && (value as number) >= 0 && (value as number) < length;
}

function positions(length: number): string {
  return `a whole number from 0 to ${length - 1}`;
}

function version(value: unknown, path: string): void {
  if (value !== 1) fail(path, 'version 1 (take the viewer that comes with the snell that wrote this)', value);
}

function fail(path: string, expected: string, found: unknown): never {
  const shown = found === undefined ? 'nothing' : (JSON.stringify(found) ?? String(found));
  throw new ViewerDataError(`${path}: expected ${expected}, found ${shown.length > 60 ? `${shown.slice(0, 60)}…` : shown}`);
}
