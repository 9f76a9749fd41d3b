/** What may stand where in a scene, by its JSON Schema. */

import schema from '../../../docs/scene.schema.json';

interface Node {
  $ref?: string;
  description?: string;
  type?: string | string[];
  default?: unknown;
  const?: string;
  properties?: Record<string, Node>;
  additionalProperties?: Node | boolean;
  required?: string[];
  items?: Node;
  anyOf?: Node[];
  oneOf?: Node[];
}

export interface Entry {
  name: string;
  description: string;
  /** As TOML has it, if something is meant where it is left out. */
  default?: string;
  isRequired: boolean;
}

export interface Value {
  /** As TOML has it, texts with their quotes. */
  toml: string;
  description: string;
}

const ROOT = schema as unknown as Node;
const DEFINITIONS = schema.$defs as unknown as Record<string, Node>;

/** The keys of the table at a path, in which elements of lists have no names. */
export function entriesAt(path: readonly string[]): Entry[] {
  return nodesAt(path).flatMap(elements).flatMap((node) =>
    Object.entries(node.properties ?? {})
      // Only JSON has use for it: editors of TOML take a comment.
      .filter(([name]) => name !== '$schema')
      .map(([name, entry]) => ({ name, ...described(entry), isRequired: node.required?.includes(name) ?? false })),
  );
}

/** The key at a path. */
export function entryAt(path: readonly string[]): Entry | undefined {
  const name = path.at(-1);
  return entriesAt(path.slice(0, -1)).find((entry) => entry.name === name);
}

/** The values that a key at a path may have, if they are few. */
export function valuesAt(path: readonly string[]): Value[] {
  return nodesAt(path).flatMap((node): Value[] => {
    if (node.const !== undefined) return [{ toml: JSON.stringify(node.const), description: node.description ?? '' }];
    return node.type === 'boolean' ? ['true', 'false'].map((toml) => ({ toml, description: '' })) : [];
  });
}

/** The names of tables, or of lists of tables, that a scene may have: some of the former are tables of what is named freely. */
export function headers(kind: 'table' | 'element'): (Entry & { isNamed: boolean })[] {
  return entriesAt([]).flatMap((entry) => {
    const nodes = nodesOf(ROOT.properties![entry.name]!);
    const isTable = nodes.some((node) => node.type === 'object');
    const isList = nodes.some((node) => node.items && elements(node).some((item) => item.type === 'object'));
    const isNamed = nodes.some((node) => typeof node.additionalProperties === 'object');
    return (kind === 'table' ? isTable : isList) ? [{ ...entry, isNamed }] : [];
  });
}

function described(node: Node): { description: string; default?: string } {
  const description = node.description ?? '';
  return node.default === undefined ? { description } : { description, default: JSON.stringify(node.default) };
}

/** What a path leads to: several, where there is a choice. */
function nodesAt(path: readonly string[]): Node[] {
  return path.reduce((nodes, name) => nodes.flatMap((node) => nodesIn(node, name)), nodesOf(ROOT));
}

function nodesIn(node: Node, name: string): Node[] {
  if (node.items) return elements(node).flatMap((item) => nodesIn(item, name));
  const inner = Object.hasOwn(node.properties ?? {}, name) ? node.properties![name] : node.additionalProperties;
  return typeof inner === 'object' ? nodesOf(inner) : [];
}

/** What a list is a list of, or itself. */
function elements(node: Node): Node[] {
  return node.items ? nodesOf(node.items).flatMap(elements) : [node];
}

/** The choices that a node gives. */
function nodesOf(node: Node): Node[] {
  if (node.$ref) return nodesOf(DEFINITIONS[node.$ref.slice('#/$defs/'.length)]!);
  const choices = node.anyOf ?? node.oneOf;
  return choices ? choices.flatMap(nodesOf) : [node];
}
