/** Spheres and meshes, shaded softly from above, with a rim: a drawing, not a rendering. */

import {
  BufferGeometry,
  Color,
  DoubleSide,
  EdgesGeometry,
  Float32BufferAttribute,
  FrontSide,
  Group,
  Mesh,
  ShaderMaterial,
  SphereGeometry,
  Vector3,
} from 'three';
import { displayed } from '../color';
import type { Transfer, Vec3, ViewMesh, ViewScene, ViewSphere } from '../data';
import type { Theme } from '../theme';
import { type DrawnLine, LineSet, type ScreenUniforms, screenColor } from './line-set';

const VERTEX = /* glsl */ `
varying vec3 vNormal;
varying vec3 vToEye;
varying float vHeight;
uniform vec3 up;

void main() {
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  vNormal = normalMatrix * normal;
  vToEye = -place.xyz;
  vHeight = dot(normalize(normal), up);
  gl_Position = projectionMatrix * place;
}`;

const FRAGMENT = /* glsl */ `
uniform vec3 color;
uniform vec3 paper;
uniform float opacity;
uniform float rim;
varying vec3 vNormal;
varying vec3 vToEye;
varying float vHeight;

void main() {
  float facing = abs(dot(normalize(vNormal), normalize(vToEye)));
  float height = gl_FrontFacing ? vHeight : -vHeight;
  float light = 0.5 + 0.5 * height;
  // Some of the paper in everything: soft on a light page; on a dark one pale things would outshine the rays.
  float pale = min(color.r, min(color.g, color.b));
  vec3 soft = mix(color, paper, mix(0.28 + 0.38 * pale, 0.2, paper.g));
  vec3 shade = soft * (0.68 + 0.32 * light) + 0.07 * light * light;
  float edge = rim * pow(1.0 - facing, 3.0);
  // Opaque things fade into the paper at their rim, clear ones stand out from it there.
  vec3 outline = opacity < 1.0 ? mix(color, vec3(1.0 - paper.g), 0.2) : mix(shade, paper, 0.5);
  vec3 tint = mix(shade, outline, edge);
  gl_FragColor = vec4(tint, opacity < 1.0 ? mix(opacity * 0.7, 0.75, edge) : 1.0);
}`;

const MAX_FINE = 100;
/** Edges between faces that meet at less than this are smooth, in degrees. */
const CREASE = 25;
/** Above, the edges of a mesh would be a web. */
const MAX_EDGE_FACES = 5000;

export class Objects {
  readonly group = new Group();
  private readonly materials: ShaderMaterial[] = [];
  private readonly edges: LineSet;
  private readonly creases: [Vec3, Vec3][] = [];

  constructor(
    scene: ViewScene,
    private readonly transfer: Transfer,
    uniforms: ScreenUniforms,
  ) {
    // Over all surfaces, but under the picture on the image plane.
    this.edges = new LineSet(uniforms, 9);
    const up = new Vector3(...scene.camera.up).normalize();
    // Many spheres are small ones.
    const round = scene.spheres.length <= MAX_FINE ? new SphereGeometry(1, 96, 64) : new SphereGeometry(1, 24, 16);
    for (const sphere of scene.spheres) {
      const mesh = new Mesh(round, this.material(sphere, up, FrontSide, 1));
      mesh.position.set(...sphere.center);
      mesh.scale.setScalar(sphere.radius);
      this.add(mesh);
    }
    for (const mesh of scene.meshes) {
      const flat = flatGeometry(mesh);
      this.add(new Mesh(flat, this.material(mesh, up, DoubleSide, 0)));
      if (mesh.faces.length <= 3 * MAX_EDGE_FACES) this.creases.push(...creases(flat));
    }
    this.group.add(this.edges.group);
  }

  setTheme(theme: Theme): void {
    for (const material of this.materials) (material.uniforms.paper!.value as Color).fromArray(screenColor(theme.paper));
    const edge = { color: theme.ink, width: 1, opacity: 0.32, open: false };
    this.edges.set(this.creases.map(([from, to]): DrawnLine => ({ from, to, ...edge })));
  }

  dispose(): void {
    this.edges.dispose();
    for (const material of this.materials) material.dispose();
    for (const child of this.group.children) if (child instanceof Mesh) (child.geometry as BufferGeometry).dispose();
  }

  private add(mesh: Mesh<BufferGeometry, ShaderMaterial>): void {
    mesh.renderOrder = mesh.material.transparent ? 1 : 0;
    this.group.add(mesh);
  }

  private material(of: ViewSphere | ViewMesh, up: Vector3, side: typeof FrontSide | typeof DoubleSide, rim: number): ShaderMaterial {
    const opaque = of.opacity >= 1;
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        color: { value: new Color().fromArray(displayed(of.color, this.transfer)) },
        paper: { value: new Color() },
        opacity: { value: of.opacity },
        rim: { value: rim },
        up: { value: up },
      },
      side,
      transparent: !opaque,
      depthWrite: opaque,
      // Edges lie in the faces, and must win.
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    this.materials.push(material);
    return material;
  }
}

/** Each face with corners and a normal of its own. */
export function flatGeometry({ vertices, faces }: ViewMesh): BufferGeometry {
  const indexed = new BufferGeometry();
  indexed.setAttribute('position', new Float32BufferAttribute(vertices, 3));
  indexed.setIndex(faces);
  const flat = indexed.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}

/** The edges of a mesh at which it is not smooth. */
export function creases(flat: BufferGeometry): [Vec3, Vec3][] {
  flat.computeBoundingSphere();
  // three.js takes corners within 1e-4 for one: a millionth of the mesh, when it is as large as this.
  const size = 100 / (flat.boundingSphere!.radius || 1);
  const large = flat.clone().scale(size, size, size);
  const edges = new EdgesGeometry(large, CREASE);
  const points = edges.getAttribute('position');
  const point = (index: number): Vec3 => [points.getX(index) / size, points.getY(index) / size, points.getZ(index) / size];
  const found: [Vec3, Vec3][] = [];
  for (let index = 0; index < points.count; index += 2) found.push([point(index), point(index + 1)]);
  edges.dispose();
  large.dispose();
  return found;
}
