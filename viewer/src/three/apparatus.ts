/** The outlines of the camera, and the lights. */

import { Group, Vector3 } from 'three';
import { along } from '../lines';
import type { Vec3, ViewScene } from '../data';
import type { Theme } from '../theme';
import { arrowStart, type Extent } from './extent';
import { type DrawnLine, LineSet, type ScreenUniforms } from './line-set';
import { type Mark, MarkSet } from './marks';

/** Of the arrow of a light at infinity, in radii of the drawing. */
const ARROW = 0.22;

export class Apparatus {
  readonly group = new Group();
  private readonly lines: LineSet;
  private readonly marks: MarkSet;

  constructor(uniforms: ScreenUniforms) {
    this.lines = new LineSet(uniforms);
    this.marks = new MarkSet(uniforms);
    this.group.add(this.lines.group, this.marks.points);
  }

  set(scene: ViewScene, extent: Extent, theme: Theme): void {
    const { eye, corners } = scene.camera;
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
      ...scene.lights.flatMap(({ direction }) => (direction === null ? [] : sunlight(direction, scene, extent, theme))),
    ]);
    const lamps = scene.lights.flatMap(({ position }) => (position === null ? [] : [position]));
    this.marks.set([
      { at: eye, color: theme.ink, size: 6, opacity: 0.9 },
      ...lamps.map((at): Mark => ({ at, color: theme.bulb, size: 30, opacity: 1, shape: 'lamp' })),
    ]);
  }

  dispose(): void {
    this.lines.dispose();
    this.marks.dispose();
  }
}

/** Three parallel arrows: from infinitely far away all of its light comes from the same side. */
function sunlight(direction: Vec3, scene: ViewScene, extent: Extent, theme: Theme): DrawnLine[] {
  const start = arrowStart(direction, extent);
  const towards = new Vector3(...direction).normalize();
  const up = new Vector3(...scene.camera.up);
  const side = new Vector3().crossVectors(towards, Math.abs(towards.dot(up.normalize())) < 0.99 ? up : new Vector3(1, 0, 0.5));
  side.setLength(0.05 * extent.radius);
  return [-1, 0, 1].map((place) => {
    const from = start.clone().addScaledVector(side, place).toArray();
    const to = along(from, towards.toArray(), -ARROW * extent.radius);
    return { from, to, color: theme.bulb, width: 1.6, opacity: 0.95, open: false, arrow: true };
  });
}
