/** Spheres and meshes, shaded softly from above, with a rim: a drawing, not a rendering. */

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  FrontSide,
  Group,
  Mesh,
  ShaderMaterial,
  Sphere,
  SphereGeometry,
  Vector3,
} from 'three';
import { displayed } from '../color';
import type { ViewMesh, ViewScene, ViewSphere } from '../data';
import type { Theme } from '../theme';
import { creases } from './creases';
import { boxOf } from './extent';
import { type DrawnLine, LineSet, type ScreenUniforms, screenColor } from './line-set';

/** Faces of meshes get their normal from the graphics card, so that none has to be computed for large ones. */
const VERTEX = /* glsl */ `
varying vec3 vNormal;
varying vec3 vToEye;

void main() {
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  #ifdef ROUND
  vNormal = normalMatrix * normal;
  #endif
  vToEye = -place.xyz;
  gl_Position = projectionMatrix * place;
}`;

const FRAGMENT = /* glsl */ `
uniform vec3 color;
uniform vec3 paper;
uniform vec3 up;
uniform float opacity;
varying vec3 vNormal;
varying vec3 vToEye;

void main() {
  #ifdef ROUND
  vec3 normal = normalize(vNormal);
  float facing = abs(dot(normal, normalize(vToEye)));
  float edge = pow(1.0 - facing, 3.0);
  #else
  vec3 normal = normalize(cross(dFdx(vToEye), dFdy(vToEye)));
  normal *= sign(dot(normal, vToEye));
  float edge = 0.0;
  #endif
  float light = 0.5 + 0.5 * dot(normal, mat3(viewMatrix) * up);
  // Some of the paper in everything: soft on a light page; on a dark one pale things would outshine the rays.
  float pale = min(color.r, min(color.g, color.b));
  vec3 soft = mix(color, paper, mix(0.28 + 0.38 * pale, 0.2, paper.g));
  vec3 shade = soft * (0.68 + 0.32 * light) + 0.07 * light * light;
  // Opaque things fade into the paper at their rim, clear ones stand out from it there.
  vec3 outline = opacity < 1.0 ? mix(color, vec3(1.0 - paper.g), 0.2) : mix(shade, paper, 0.5);
  vec3 tint = mix(shade, outline, edge);
  gl_FragColor = vec4(tint, opacity < 1.0 ? mix(opacity * 0.7, 0.75, edge) : 1.0);
}`;

const MAX_FINE = 100;
/** Above, the edges of a mesh would be a web. */
const MAX_EDGE_FACES = 5000;

type Drawn = Mesh<BufferGeometry, ShaderMaterial>;

export class Objects {
  readonly group = new Group();
  private readonly spheres: Drawn[] = [];
  meshes: Drawn[] = [];
  private readonly fine = new SphereGeometry(1, 96, 64);
  /** Many spheres are small ones. */
  private readonly coarse = new SphereGeometry(1, 24, 16);
  private readonly edges: LineSet;
  private shown: ViewMesh[] = [];
  private ink = '#000';

  constructor(uniforms: ScreenUniforms) {
    // Over all surfaces, but under the picture on the image plane.
    this.edges = new LineSet(uniforms, 9);
    this.group.add(this.edges.group);
  }

  /** What is the same as before is kept. */
  setScene(scene: ViewScene, theme: Theme): void {
    const changed = this.setMeshes(scene.meshes);
    this.setSpheres(scene.spheres);
    const up = new Vector3(...scene.camera.up).normalize();
    const paint = ({ material }: Drawn, { color, opacity }: ViewSphere | ViewMesh) => {
      const opaque = opacity >= 1;
      const { uniforms } = material;
      (uniforms.color!.value as Color).fromArray(displayed(color, scene.transfer));
      (uniforms.up!.value as Vector3).copy(up);
      uniforms.opacity!.value = opacity;
      material.transparent = !opaque;
      material.depthWrite = opaque;
    };
    this.spheres.forEach((drawn, index) => paint(drawn, scene.spheres[index]!));
    this.meshes.forEach((drawn, index) => paint(drawn, scene.meshes[index]!));
    for (const drawn of [...this.spheres, ...this.meshes]) drawn.renderOrder = drawn.material.transparent ? 1 : 0;
    this.setTheme(theme, changed);
  }

  setTheme(theme: Theme, edgesToo = true): void {
    for (const { material } of [...this.spheres, ...this.meshes]) {
      (material.uniforms.paper!.value as Color).fromArray(screenColor(theme.paper));
    }
    if (!edgesToo && theme.ink === this.ink) return;
    this.ink = theme.ink;
    const edge = { color: theme.ink, width: 1, opacity: 0.32, open: false };
    const edged = this.shown.filter(({ faces }) => faces.length <= 3 * MAX_EDGE_FACES);
    this.edges.set(edged.flatMap((mesh) => creases(mesh).map(([from, to]): DrawnLine => ({ from, to, ...edge }))));
  }

  dispose(): void {
    this.edges.dispose();
    this.fine.dispose();
    this.coarse.dispose();
    for (const { material } of this.spheres) material.dispose();
    for (const drawn of this.meshes) this.drop(drawn);
  }

  private setSpheres(spheres: ViewSphere[]): void {
    for (const { material } of this.spheres.slice(spheres.length)) material.dispose();
    this.group.remove(...this.spheres.splice(spheres.length));
    while (this.spheres.length < spheres.length) this.spheres.push(this.add(new Mesh(this.fine, surface(true))));
    spheres.forEach(({ center, radius }, index) => {
      const drawn = this.spheres[index]!;
      drawn.geometry = spheres.length <= MAX_FINE ? this.fine : this.coarse;
      drawn.position.set(...center);
      drawn.scale.setScalar(radius);
    });
  }

  /** Are some of them, or are there, others than before? */
  private setMeshes(meshes: ViewMesh[]): boolean {
    const before = this.shown;
    const kept = new Map(before.map((mesh, index) => [mesh, this.meshes[index]!]));
    const find = (mesh: ViewMesh) => {
      const same = [...kept.keys()].find(({ vertices, faces }) => vertices === mesh.vertices && faces === mesh.faces);
      if (same === undefined) return undefined;
      const drawn = kept.get(same)!;
      kept.delete(same);
      return drawn;
    };
    const found = meshes.map(find);
    this.meshes = meshes.map((mesh, index) => found[index] ?? this.add(new Mesh(geometryOf(mesh), surface(false))));
    for (const drawn of kept.values()) {
      this.drop(drawn);
      this.group.remove(drawn);
    }
    this.shown = meshes;
    return kept.size > 0 || found.includes(undefined);
  }

  private add(drawn: Drawn): Drawn {
    this.group.add(drawn);
    return drawn;
  }

  private drop({ geometry, material }: Drawn): void {
    geometry.dispose();
    material.dispose();
  }
}

function surface(round: boolean): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    defines: round ? { ROUND: true } : {},
    uniforms: {
      color: { value: new Color() },
      paper: { value: new Color() },
      opacity: { value: 1 },
      up: { value: new Vector3() },
    },
    side: round ? FrontSide : DoubleSide,
    // Edges lie in the faces, and must win.
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}

function geometryOf(mesh: ViewMesh): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(mesh.vertices), 3));
  geometry.setIndex(new BufferAttribute(new Uint32Array(mesh.faces), 1));
  // three.js would go through the vertices once more.
  geometry.boundingBox = boxOf(mesh);
  geometry.boundingSphere = geometry.boundingBox.getBoundingSphere(new Sphere());
  return geometry;
}
