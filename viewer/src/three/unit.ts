/**
 * The drawing's own unit of length. three.js and the numbers of a GPU expect things of a size of about 1: controls overlook smaller
 * moves than a thousandth, whatever a scene is measured in.
 */

import type { Numbers, RayNode, Vec3, ViewScene } from '../data';

/** By what to multiply so that a radius comes near 1: a power of two, which loses no digit. */
export function unitFor(radius: number): number {
  return 2 ** -Math.round(Math.log2(radius));
}

export function scaledScene(scene: ViewScene, factor: number): ViewScene {
  const point = (at: Vec3) => scaled(at, factor);
  const { eye, corners, up } = scene.camera;
  const [leftBottom, rightBottom, leftTop, rightTop] = corners;
  return {
    ...scene,
    spheres: scene.spheres.map((sphere) => ({ ...sphere, center: point(sphere.center), radius: factor * sphere.radius })),
    meshes: scene.meshes.map((mesh) => ({ ...mesh, vertices: scaledVertices(mesh.vertices, factor) })),
    camera: { eye: point(eye), corners: [point(leftBottom), point(rightBottom), point(leftTop), point(rightTop)], up },
    lights: scene.lights.map((light) => ({ ...light, position: light.position && point(light.position) })),
  };
}

export function scaledNodes(nodes: RayNode[], factor: number): RayNode[] {
  const point = (at: Vec3) => scaled(at, factor);
  return nodes.map((node) => ({
    ...node,
    origin: point(node.origin),
    hit: node.hit && { ...node.hit, t: factor * node.hit.t, point: point(node.hit.point) },
    local: node.local && {
      ...node.local,
      lights: node.local.lights.map((light) => ({
        ...light,
        block_point: light.block_point && point(light.block_point),
        point: light.at_infinity ? light.point : point(light.point),
      })),
    },
  }));
}

const known = new WeakMap<Numbers, { factor: number; vertices: Float64Array }>();

/** The same list again for the same vertices: what is made of them need not be made again. */
function scaledVertices(given: Numbers, factor: number): Float64Array {
  const before = known.get(given);
  if (before?.factor === factor) return before.vertices;
  const vertices = new Float64Array(given);
  for (let index = 0; index < vertices.length; index++) vertices[index]! *= factor;
  known.set(given, { factor, vertices });
  return vertices;
}

function scaled([x, y, z]: Vec3, factor: number): Vec3 {
  return [factor * x, factor * y, factor * z];
}
