/** A scene that shows a model that came alone: on a floor, from in front and a little above. */

import { numberText, vectorText, type Vec3 } from '../scene/objects';

/** The first text, by which the engine finds out how large the model is. */
export function textFor(model: string): string {
  return `# Shows ${model.replace(/[^\x20-\x7e]/g, '?')}.

snell = 1
background = [0.55, 0.68, 0.85]
ambient = 0.25

[render]
integrator = "whitted"
size = [512, 512]

[camera]
eye = [0, 0, 1]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov = 35

[[light]]
name = "sun"
direction = [-0.4, 0.9, 0.6]
color = 0.85

[material.model]
ka = 0.8
kd = [0.75, 0.72, 0.68]
ks = 0.2
spow = 40

[material.floor]
ka = 0.9
kd = 0.8
texture = "tiles"

[texture.tiles]
checker = [[0.85, 0.85, 0.83], [0.35, 0.38, 0.42]]
repeat = [24, 24]

[[mesh]]
name = "model"
file = ${JSON.stringify(model.split('/').at(-1))}
material = "model"

[[plane]]
name = "floor"
center = [0, 0, 0]
size = [1, 1]
material = "floor"
`;
}

/** Where the camera and the floor belong, for a model of this size. */
export function editsFor(center: Vec3, radius: number, low: number): [string, string][] {
  const eye: Vec3 = [center[0] + 0.9 * radius, center[1] + 1.1 * radius, center[2] + 3.6 * radius];
  return [
    ['camera.eye', vectorText(eye)],
    ['camera.look_at', vectorText(center)],
    ['plane.floor.center', vectorText([center[0], low, center[2]])],
    ['plane.floor.size', `[${numberText(24 * radius)}, ${numberText(24 * radius)}]`],
  ];
}
