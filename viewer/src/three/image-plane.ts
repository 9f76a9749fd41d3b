/** The image plane of the camera: a tint, or the picture with a mark on the pixel that is explained. */

import {
  BufferGeometry,
  Color,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  LinearFilter,
  LinearMipmapLinearFilter,
  MathUtils,
  Mesh,
  type PerspectiveCamera,
  type Ray,
  ShaderMaterial,
  Texture,
  Vector2,
  Vector3,
} from 'three';
import type { Vec3, ViewCamera } from '../data';
import type { Pixel } from '../pixels';
import type { Theme } from '../theme';
import { screenColor, type ScreenUniforms } from './line-set';
import { MarkSet } from './marks';

const VERTEX = /* glsl */ `
varying vec2 vPlace;

void main() {
  vPlace = uv;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const TINT = 'uniform vec3 color; void main() { gl_FragColor = vec4(color, 0.07); }';

/** Pixels stay squares when the eye comes near, with edges as soft as a pixel of the screen. */
const PICTURE = /* glsl */ `
uniform sampler2D map;
uniform vec2 size;
varying vec2 vPlace;

void main() {
  vec2 at = vPlace * size;
  vec2 edge = floor(at + 0.5);
  at = edge + clamp((at - edge) / min(fwidth(at), 1.0), -0.5, 0.5);
  // What is not rendered yet is clear.
  gl_FragColor = textureGrad(map, at / size, dFdx(vPlace), dFdy(vPlace));
}`;

/** Among translucent things: behind all others, and over all surfaces and their edges but under the rays. */
const [BEHIND, BEFORE] = [0.5, 9.5];

/** Pixels of the screen. */
const MARK = 13;

export type Picture = ImageBitmap | HTMLCanvasElement | OffscreenCanvas;

export class ImagePlane {
  readonly group = new Group();
  /** Columns and rows of the picture. */
  size: Pixel | null = null;
  private readonly tint: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly picture: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly marks: MarkSet;
  private readonly geometry = new BufferGeometry();
  private readonly corner = new Vector3();
  private readonly right = new Vector3();
  private readonly down = new Vector3();
  /** Towards the scene. */
  private readonly forward = new Vector3();
  /** What is marked, as parts of the width and of the height. */
  private place: [number, number] | null = null;
  private texture: Texture<Picture> | null = null;
  private shown = true;

  constructor(uniforms: ScreenUniforms) {
    this.geometry.setAttribute('position', new Float32BufferAttribute(new Float32Array(12), 3));
    // Row 0 of a picture is its top.
    this.geometry.setAttribute('uv', new Float32BufferAttribute([0, 1, 1, 1, 0, 0, 1, 0], 2));
    this.geometry.setIndex([0, 1, 3, 0, 3, 2]);
    const material = (fragmentShader: string, own: ShaderMaterial['uniforms']) =>
      new ShaderMaterial({ vertexShader: VERTEX, fragmentShader, uniforms: own, side: DoubleSide, transparent: true, depthWrite: false });
    this.tint = new Mesh(this.geometry, material(TINT, { color: { value: new Color() } }));
    this.tint.renderOrder = 2;
    this.picture = new Mesh(this.geometry, material(PICTURE, { map: { value: null }, size: { value: new Vector2() } }));
    for (const mesh of [this.tint, this.picture]) mesh.frustumCulled = false;
    this.marks = new MarkSet(uniforms);
    this.group.add(this.tint, this.picture, this.marks.points);
    this.update();
  }

  setCamera({ eye, corners }: ViewCamera): void {
    const [leftBottom, , leftTop, rightTop] = corners.map((corner) => new Vector3(...corner)) as [Vector3, Vector3, Vector3, Vector3];
    this.corner.copy(leftTop);
    this.right.subVectors(rightTop, leftTop);
    this.down.subVectors(leftBottom, leftTop);
    this.forward.crossVectors(this.right, this.down);
    if (leftTop.sub(new Vector3(...eye)).dot(this.forward) < 0) this.forward.negate();
    const position = this.geometry.getAttribute('position');
    position.array.set(corners.flat());
    position.needsUpdate = true;
    this.mark(this.place);
  }

  setTheme(theme: Theme): void {
    (this.tint.material.uniforms.color!.value as Color).fromArray(screenColor(theme.accent));
  }

  /** `size` is that of the picture itself; the image may be a smaller copy, or a canvas that changes. */
  setPicture(image: Picture | null, size: Pixel | null): void {
    this.size = size;
    if (image !== null && image === this.texture?.image) return this.pictureChanged();
    this.dropTexture();
    if (image !== null) {
      const still = image instanceof ImageBitmap;
      this.texture = new Texture(image);
      this.texture.flipY = false;
      this.texture.magFilter = LinearFilter;
      // Smaller copies would have to be made with each change.
      this.texture.minFilter = still ? LinearMipmapLinearFilter : LinearFilter;
      this.texture.generateMipmaps = still;
      this.texture.anisotropy = still ? 16 : 1;
      this.picture.material.uniforms.map!.value = this.texture;
      this.pictureChanged();
    }
    this.update();
  }

  /** What the picture's canvas shows is looked at again. */
  pictureChanged(): void {
    if (this.texture === null) return;
    const { width, height } = this.texture.image;
    const size = this.picture.material.uniforms.size!.value as Vector2;
    // The graphics card keeps a place of this size for it.
    if (size.x !== width || size.y !== height) this.texture.dispose();
    size.set(width, height);
    this.texture.needsUpdate = true;
  }

  showPicture(shown: boolean): void {
    this.shown = shown;
    this.update();
  }

  /** Marks a place: parts of the width from the left and of the height from the top. */
  mark(place: [number, number] | null): void {
    this.place = place;
    const at = place && this.corner.clone().addScaledVector(this.right, place[0]).addScaledVector(this.down, place[1]);
    this.marks.set(at === null ? [] : [{ at: at.toArray() as Vec3, color: '#ffffff', size: MARK, opacity: 1, shape: 'frame' }]);
  }

  /** Before each frame; `height` is that of the drawing in pixels. */
  prepare(camera: PerspectiveCamera, height: number): void {
    const to = this.corner.clone().sub(camera.position);
    // Nearly all things are behind the plane as the camera sees it: the picture covers them from there, and they it from beyond.
    this.picture.renderOrder = to.dot(this.forward) < 0 ? BEHIND : BEFORE;
    // The mark must not hide a small picture.
    const pixels = (height * this.down.length()) / (2 * Math.tan(MathUtils.degToRad(camera.fov) / 2) * to.length());
    this.marks.points.visible = this.picture.visible && pixels > 8 * MARK;
  }

  /** The pixel of the picture that a line of sight goes through, and how far away it is. */
  pixelAt(ray: Ray): { at: Pixel; distance: number } | null {
    if (this.size === null || !this.shown) return null;
    const distance = this.corner.clone().sub(ray.origin).dot(this.forward) / ray.direction.dot(this.forward);
    if (!(distance > 0)) return null;
    const to = ray.at(distance, new Vector3()).sub(this.corner);
    const [width, height] = this.size;
    const x = Math.floor((width * to.dot(this.right)) / this.right.lengthSq());
    const y = Math.floor((height * to.dot(this.down)) / this.down.lengthSq());
    return x >= 0 && x < width && y >= 0 && y < height ? { at: [x, y], distance } : null;
  }

  dispose(): void {
    this.dropTexture();
    this.marks.dispose();
    this.geometry.dispose();
    this.tint.material.dispose();
    this.picture.material.dispose();
  }

  private update(): void {
    this.picture.visible = this.texture !== null && this.shown;
    this.tint.visible = !this.picture.visible;
  }

  private dropTexture(): void {
    if (this.texture?.image instanceof ImageBitmap) this.texture.image.close();
    this.texture?.dispose();
    this.texture = null;
  }
}
