/** The camera with its image plane, and the lights. */

import { BufferGeometry, Color, DoubleSide, Float32BufferAttribute, Group, Mesh, ShaderMaterial, Vector3 } from 'three';
import { along } from '../lines';
import type { Vec3, ViewScene } from '../data';
import type { Theme } from '../theme';
import { arrowStart, type Extent } from './extent';
import { type DrawnLine, LineSet, screenColor, type ScreenUniforms } from './line-set';
import { type Mark, MarkSet } from './marks';

/** Of the arrow of a light at infinity, in radii of the drawing. */
const ARROW = 0.22;

export class Apparatus {
  readonly group = new Group();
  private readonly lines: LineSet;
  private readonly marks: MarkSet;
  private readonly plane: Mesh<BufferGeometry, ShaderMaterial>;

  constructor(
    private readonly scene: ViewScene,
    private readonly extent: Extent,
    uniforms: ScreenUniforms,
  ) {
    this.lines = new LineSet(uniforms);
    this.marks = new MarkSet(uniforms);
    this.plane = imagePlane(scene);
    this.group.add(this.plane, this.lines.group, this.marks.points);
  }

  setTheme(theme: Theme): void {
    (this.plane.material.uniforms.color!.value as Color).fromArray(screenColor(theme.accent));
    const { eye, corners } = this.scene.camera;
    const [leftBottom, rightBottom, leftTop, rightTop] = corners;
    const line = (from: Vec3, to: Vec3, opacity: number): DrawnLine => ({ from, to, color: theme.ink, width: 1, opacity, open: false });
    const frame: [Vec3, Vec3][] = [
      [leftBottom, rightBottom],
      [rightBottom, rightTop],
      [rightTop, leftTop],
      [leftTop, leftBottom],
    ];
    this.lines.set([
      ...corners.map((corner) => line(eye, corner, 0.4)),
      ...frame.map(([from, to]) => line(from, to, 0.75)),
      ...this.scene.lights.flatMap(({ direction }) => (direction === null ? [] : this.sunlight(direction, theme))),
    ]);
    const lamps = this.scene.lights.flatMap(({ position }) => (position === null ? [] : [position]));
    this.marks.set([
      { at: eye, color: theme.ink, size: 6, opacity: 0.9 },
      ...lamps.map((at): Mark => ({ at, color: theme.bulb, size: 30, opacity: 1, lamp: true })),
    ]);
  }

  dispose(): void {
    this.lines.dispose();
    this.marks.dispose();
    this.plane.geometry.dispose();
    this.plane.material.dispose();
  }

  /** Three parallel arrows: from infinitely far away all of its light comes from the same side. */
  private sunlight(direction: Vec3, theme: Theme): DrawnLine[] {
    const start = arrowStart(direction, this.extent);
    const towards = new Vector3(...direction).normalize();
    const up = new Vector3(...this.scene.camera.up);
    const side = new Vector3().crossVectors(towards, Math.abs(towards.dot(up.normalize())) < 0.99 ? up : new Vector3(1, 0, 0.5));
    side.setLength(0.05 * this.extent.radius);
    return [-1, 0, 1].map((place) => {
      const from = start.clone().addScaledVector(side, place).toArray();
      const to = along(from, towards.toArray(), -ARROW * this.extent.radius);
      return { from, to, color: theme.bulb, width: 1.6, opacity: 0.95, open: false, arrow: true };
    });
  }
}

function imagePlane(scene: ViewScene): Mesh<BufferGeometry, ShaderMaterial> {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(scene.camera.corners.flat(), 3));
  geometry.setIndex([0, 1, 3, 0, 3, 2]);
  const material = new ShaderMaterial({
    vertexShader: 'void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
    fragmentShader: 'uniform vec3 color; void main() { gl_FragColor = vec4(color, 0.07); }',
    uniforms: { color: { value: new Color() } },
    side: DoubleSide,
    transparent: true,
    depthWrite: false,
  });
  const mesh = new Mesh(geometry, material);
  mesh.renderOrder = 2;
  return mesh;
}
