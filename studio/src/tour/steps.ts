/** The lecture as a walk of twelve steps. Each sets up a scene, asks a question, and lets one find the answer with the tools. */

import type { RayNode, RayTreeDocument } from 'snell-viewer';
import type { Edit } from '../engine/protocol';
import type { Store } from '../store';

export interface TourStep {
  title: string;
  /** What is to be seen. */
  text: string;
  task: string;
  /** For those who have looked, and found it or not. */
  answer: string;
  scene: string;
  edits?: Edit[];
  /** Has it been found? Reads signals, and nothing else. */
  found(store: Store): boolean;
}

/** The rays of the pixel that somebody has clicked. */
function pinned(store: Store): RayNode[] {
  const tree = pinnedTree(store);
  return tree === null ? [] : tree.samples.flatMap((sample) => sample.nodes);
}

function pinnedTree(store: Store): RayTreeDocument | null {
  const [pixel, tree] = [store.pinned.value, store.tree.value];
  return pixel && tree && tree.pixel[0] === pixel[0] && tree.pixel[1] === pixel[1] ? tree : null;
}

function firstHit(store: Store): string | undefined {
  return pinned(store)[0]?.hit?.object;
}

const render = (store: Store) => store.revision.value?.scene.render;
const eta = (store: Store, name = 'glass') => store.revision.value?.scene.material?.[name]?.eta;

export const STEPS: TourStep[] = [
  {
    title: 'Four spheres',
    text: 'A glass sphere stands in front of three mirrors: a red, a green and a blue one. Two lights shine from above. For each pixel a ray goes from the eye through the image plane; what it meets first decides the colour. But the glass shows more than itself.',
    task: 'Click a pixel of the glass sphere. Its rays appear in the scene beside the picture.',
    answer: 'The ray meets the glass, and two rays leave from there: one is mirrored, one goes through. Each asks the same question again: what do I meet? That is recursion.',
    scene: 'lecture/default',
    found: (store) => firstHit(store) === 'glass' && pinned(store).length > 1,
  },
  {
    title: 'No bounce at all',
    text: 'How far are rays followed? The depth says how many bounces may come after the ray from the eye. At 6 the picture is complete, to our eyes.',
    task: 'In the panel “Scene”, set the depth to 0.',
    answer: 'Without bounces each sphere shows only its own colour, as the lights and the ambient light make it: nothing is mirrored, and the glass is as dull as a stone.',
    scene: 'lecture/diamond',
    found: (store) => render(store)?.max_depth === 0,
  },
  {
    title: 'Level by level',
    text: 'Now one bounce is allowed. Add one more, and one more. With each level mirrors show mirrors that show mirrors.',
    task: 'Raise the depth to 3 or more, click a pixel in the glass, and step through its tree with the player.',
    answer: 'The rays of each generation carry a smaller share than those before, as each mirror and each way through glass takes its part. So the sum comes to rest.',
    scene: 'lecture/diamond',
    edits: [['render.max_depth', '1']],
    found: (store) => (render(store)?.max_depth ?? 0) >= 3 && pinned(store).some(({ depth }) => depth >= 2),
  },
  {
    title: 'A glass that bends nothing',
    text: 'Here the sphere has the index 1, like the space around it. Light goes straight through: what is behind the sphere is seen where it really is.',
    task: 'Click the glass sphere and look at the angles of the ray before and behind the surface. Then pull the index up, to 1.3 or more.',
    answer: 'Snell’s law: n₁ sin θ₁ = n₂ sin θ₂. With equal indices both angles are the same. With a higher index in the sphere, the ray bends towards the normal, and the picture in the sphere turns upside down.',
    scene: 'lecture/eta-1.0',
    found: (store) => (eta(store) ?? 1) >= 1.3,
  },
  {
    title: 'Upside down',
    text: 'With index 2 the rays cross inside the sphere. The red mirror stands to the upper left of it. Where is it seen in the glass?',
    task: 'Find a pixel of the glass that shows red through the glass, and click it.',
    answer: 'At the lower right: what comes from the left goes to the right, and from the top to the bottom. A glass ball on a table does the same with a window.',
    scene: 'lecture/default',
    found: (store) => firstHit(store) === 'glass' && pinned(store).some(({ kind, hit }) => kind === 'refracted' && hit?.object === 'red'),
  },
  {
    title: 'Diamond',
    text: 'Water has the index 1.33, window glass 1.52, diamond 2.42. The higher the index, the more strongly light is bent.',
    task: 'Select the glass sphere and make it a diamond: pull the index to 2.4, or choose the preset.',
    answer: 'The upside-down picture shrinks towards the middle: rays are bent so strongly that the sphere sees nearly everything behind it.',
    scene: 'lecture/default',
    edits: [['material.glass.eta', '1.33']],
    found: (store) => (eta(store) ?? 1) >= 2.4,
  },
  {
    title: 'Yellow from nowhere',
    text: 'The glass is gone. Three spheres are left: red, green and blue. Nothing here is yellow. And yet there are yellow pixels.',
    task: 'Find a yellow pixel and click it. Zoom in, if it helps.',
    answer: 'They are at the sides of red and green that face each other. Red mirrors green light, which is added to red’s own colour: red and green make yellow.',
    scene: 'lecture/no-glass',
    found: (store) => {
      const [red, green, blue] = pinnedTree(store)?.color ?? [0, 0, 0];
      return Math.min(red, green) > 0.3 && blue < Math.min(red, green) / 2;
    },
  },
  {
    title: 'Green where no green is',
    text: 'This is the lower left quarter of the picture, magnified. The green sphere stands at the upper right of the whole picture, far outside this view. But there is green.',
    task: 'Use “Where is it seen?” to find all pixels that show green. Along which paths do they see it?',
    answer: 'Green is seen through the glass, upside down, and a few pixels see it there a second time, in a mirror that green itself mirrors. The blue mirror stands in the view and does not show it. The rays decide who sees what.',
    scene: 'study/quarter-view',
    found: (store) => store.sighting.value?.object === 'green',
  },
  {
    title: 'Why is it dark here?',
    text: 'From each point that is met, a ray goes to each light. Whatever stands between takes the light away: a shadow.',
    task: 'Find a pixel that a light does not reach because something is in the way, and click it.',
    answer: 'In the lecture’s model glass throws a shadow as if it were stone. Switch the shadows off in the panel “Scene”, and look again.',
    scene: 'lecture/default',
    found: (store) => pinned(store)[0]?.local?.lights.some(({ blocked_by }) => blocked_by !== null) ?? false,
  },
  {
    title: 'Where rays end',
    text: 'Between mirrors light could go on for ever. A program has to stop: at the depth limit, rays are not followed, and what they would have brought is lost.',
    task: 'Click a pixel one of whose rays was not followed further because of the limit.',
    answer: 'Snell does not drop this without a word: the tree says where, and how much it could at most have added. The renderer counts it for the whole picture.',
    scene: 'lecture/default',
    edits: [['render.max_depth', '1']],
    found: (store) => pinned(store).some(({ ended }) => ended === 'depth'),
  },
  {
    title: 'What physics does differently',
    text: 'The lecture’s model gives each material fixed shares of mirror and glass. In nature the share depends on the angle: Fresnel’s equations say how much is mirrored, and all the rest goes through.',
    task: 'Change the model of light to “Whitted: real optics”, and watch the rim of the sphere.',
    answer: 'Head-on, glass of index 2 mirrors 11 % of the light; at the rim nearly all of it, so that a bright line appears there. In the lecture’s model the shares are fixed numbers, whatever the angle.',
    scene: 'lecture/default',
    found: (store) => render(store)?.integrator === 'whitted',
  },
  {
    title: 'Nothing gets out',
    text: 'Bubbles of air in a block of water. Where light comes from the denser side at a shallow angle, no angle behind the surface would satisfy Snell’s law, and all of it is mirrored.',
    task: 'Find a pixel in whose tree there is a total reflection.',
    answer: 'Beyond the critical angle, arcsin(1/1.333) = 48.6° for water and air, the surface is a perfect mirror. This makes diamonds sparkle, and guides light through fibres.',
    scene: 'gallery/bubbles',
    found: (store) => pinned(store).some(({ hit }) => hit?.total_reflection === true),
  },
];
