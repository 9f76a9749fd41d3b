/** Answers questions about the scene, and puts the picture together from what the renderers have made. */

import { Session } from 'snell-wasm';
import type { Answers, DistributedView, Finding, FromDesk, Geometry, PictureOptions, Question, Revision, Sighting, ToDesk } from './protocol';
import { lostLight } from './lost';
import { brokenBy, changed, findingsOf, hasLostLight, start } from './session';

let session: Session | null = null;
/** The picture that is gathered. */
let picture = -1;
/** Those that the page has been told of, and still needs. */
let geometry = new Set<string>();
let viewText = '';

self.onmessage = ({ data }: MessageEvent<ToDesk>) => {
  try {
    hear(data);
  } catch (error) {
    tell({ tell: 'broken', message: brokenBy(error) });
  }
};

function hear(message: ToDesk): void {
  switch (message.do) {
    case 'start':
      return start(message.module);
    case 'gather':
      return gather(message.picture, message.options);
    case 'part':
      if (message.picture === picture) {
        const { x, y, width, height, values, lost, finished } = message.part;
        session!.put(x, y, width, height, values, finished);
        if (lost !== null) session!.put_lost(x, y, width, height, lost);
      }
      return;
    case 'statistics':
      if (message.picture === picture) session!.put_statistics(message.statistics);
      return;
    case 'ask':
      return reply(message.id, message.question);
  }
}

function gather(number: number, options: PictureOptions): void {
  picture = -1;
  try {
    session!.gather(JSON.stringify(options));
    picture = number;
  } catch (error) {
    const findings = findingsOf(error);
    if (findings === null) throw error;
    tell({ tell: 'refused', picture: number, findings });
  }
}

function reply(id: number, question: Question): void {
  try {
    tell({ tell: 'answer', id, answer: answer(question) });
  } catch (error) {
    const findings = findingsOf(error);
    if (findings === null) throw error;
    tell({ tell: 'refusal', id, findings });
  }
}

function answer(question: Question): Answers[Question['ask']] {
  switch (question.ask) {
    case 'change':
      session = changed(session, question.change);
      picture = -1;
      return revision(session);
    case 'explain':
      return JSON.parse(session!.explain(...question.pixel)) as Answers['explain'];
    case 'find': {
      const seen = session!.find(question.object);
      const found: Sighting = { paths: JSON.parse(seen.paths) as Sighting['paths'], mask: seen.mask };
      seen.free();
      return found;
    }
    case 'path':
      return session!.find_path(question.path);
    case 'values':
      return session!.values(question.x, question.y, question.width, question.height);
    case 'outcome':
      return outcome(session!);
    case 'glasses':
      return JSON.parse(Session.glasses()) as string[];
    case 'json':
      return session!.json();
    case 'png':
      return session!.png() as Uint8Array<ArrayBuffer>;
    case 'exr':
      return session!.exr() as Uint8Array<ArrayBuffer>;
  }
}

function outcome(session: Session): Answers['outcome'] {
  const size = session.size as unknown as [number, number];
  const { film_sha256: sha256 = '', spp } = session;
  // The scene may have changed meanwhile, and then there is no picture.
  const lost = sha256 !== '' && hasLostLight(session) ? lostLight(size, spp, (y, rows) => session.lost(0, y, size[0], rows)) : null;
  return { sha256, warnings: JSON.parse(session.validate()) as Finding[], lost };
}

function revision(session: Session): Revision {
  const [width, height] = session.size as unknown as [number, number];
  return {
    text: session.text,
    scene: JSON.parse(session.scene()) as Revision['scene'],
    ...sceneOf(session),
    warnings: JSON.parse(session.validate()) as Finding[],
    size: [width, height],
  };
}

/** Corners and faces come as arrays of numbers, which are handed over much faster than JSON, and only once. */
function sceneOf(session: Session): Pick<Revision, 'view' | 'geometry'> {
  const text = session.view();
  const fresh = new Map<string, Geometry>();
  // Most edits move nothing, and then there is nothing to be drawn again.
  if (text === viewText) return { view: null, geometry: fresh };
  viewText = text;
  const view = JSON.parse(text) as DistributedView;
  const known = geometry;
  geometry = new Set(view.meshes.map((mesh) => mesh.geometry));
  view.meshes.forEach((mesh, index) => {
    if (!known.has(mesh.geometry) && !fresh.has(mesh.geometry)) fresh.set(mesh.geometry, session.view_mesh(index) as Geometry);
  });
  return { view, geometry: fresh };
}

function tell(message: FromDesk): void {
  self.postMessage(message);
}
