/** The edges of a mesh at which it is not smooth, and those at which it ends. */

import type { Numbers, Vec3, ViewMesh } from '../data';
import { dot } from '../lines';
import { boxOf } from './extent';

export type Edge = [Vec3, Vec3];

/** Edges between faces that meet at less than this are smooth. */
const CREASE = Math.cos((25 * Math.PI) / 180);
/** Corners that are nearer than this part of the mesh are one. */
const SAME = 1e-6;

const known = new WeakMap<Numbers, { faces: Numbers; edges: Edge[] }>();

/** Looked for once in the same lists. */
export function creases(mesh: ViewMesh): Edge[] {
  const before = known.get(mesh.vertices);
  if (before?.faces === mesh.faces) return before.edges;
  const edges = find(mesh);
  known.set(mesh.vertices, { faces: mesh.faces, edges });
  return edges;
}

function find(mesh: ViewMesh): Edge[] {
  const { vertices, faces } = mesh;
  const same = welded(mesh);
  const count = vertices.length / 3;
  const point = (vertex: number): Vec3 => [vertices[3 * vertex]!, vertices[3 * vertex + 1]!, vertices[3 * vertex + 2]!];
  /** Edges that one face has been seen of, with its normal. */
  const open = new Map<number, { ends: [number, number]; normal: Vec3 }>();
  const edges: Edge[] = [];
  for (let face = 0; face < faces.length; face += 3) {
    const corners = [0, 1, 2].map((corner) => same[faces[face + corner]!]!) as Vec3;
    const normal = normalOf(corners.map(point) as [Vec3, Vec3, Vec3]);
    // Of no area: it has no side.
    if (normal === null) continue;
    for (const [from, to] of [[0, 1], [1, 2], [2, 0]] as const) {
      const ends: [number, number] = [corners[from], corners[to]];
      const key = Math.min(...ends) * count + Math.max(...ends);
      const other = open.get(key);
      if (other === undefined) open.set(key, { ends, normal });
      else {
        open.delete(key);
        // Faces may be given either way round.
        const along = other.ends[0] === ends[0] ? -1 : 1;
        if (along * dot(normal, other.normal) <= CREASE) edges.push([point(ends[0]), point(ends[1])]);
      }
    }
  }
  for (const { ends } of open.values()) edges.push([point(ends[0]), point(ends[1])]);
  return edges;
}

/** For each vertex the first one at the same place. */
function welded(mesh: ViewMesh): Uint32Array {
  const { vertices } = mesh;
  const { min, max } = boxOf(mesh);
  const size = SAME * (max.distanceTo(min) || 1);
  const first = new Map<string, number>();
  return Uint32Array.from({ length: vertices.length / 3 }, (_, vertex) => {
    const place = [0, 1, 2].map((axis) => Math.round((vertices[3 * vertex + axis]! - min.getComponent(axis)) / size)).join();
    if (!first.has(place)) first.set(place, vertex);
    return first.get(place)!;
  });
}

function normalOf([a, b, c]: [Vec3, Vec3, Vec3]): Vec3 | null {
  const [u, v] = [b, c].map((to) => to.map((value, axis) => value - a[axis]!)) as [Vec3, Vec3];
  const normal: Vec3 = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const length = Math.hypot(...normal);
  return length > 0 ? (normal.map((value) => value / length) as Vec3) : null;
}
