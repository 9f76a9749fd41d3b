/** The page that explains a pixel, as `snell explain --html` writes it: one file, which needs nothing else. */

import type { RayTreeDocument, ViewScene } from 'snell-viewer';
import viewerUrl from '../../../crates/snell-formats/assets/snell-viewer.js?url';

export async function explanationPage(tree: RayTreeDocument, view: ViewScene): Promise<string> {
  // Only who wants the page needs the script that is in it.
  const answer = await fetch(viewerUrl);
  if (!answer.ok) throw new Error('The script of the page could not be loaded: is this page offline?');
  return pageOf(tree, view, await answer.text());
}

export function pageOf(tree: RayTreeDocument, view: ViewScene, viewer: string): string {
  const meshes = view.meshes.map((mesh) => ({ ...mesh, vertices: Array.from(mesh.vertices), faces: Array.from(mesh.faces) }));
  // Nothing in a text may end the script that holds it.
  const data = (value: unknown) => JSON.stringify(value).replaceAll('<', '\\u003c');
  const title = `${tree.scene} ${tree.pixel.join()}`.replaceAll('&', '&amp;').replaceAll('<', '&lt;');
  return `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${title}</title>
<style>body { margin: 0 }</style>
<div id="snell"></div>
<script>${viewer}</script>
<script>
SnellViewer.mount(document.getElementById('snell'), { scene: ${data({ ...view, meshes })}, tree: ${data(tree)} });
</script>
</html>
`;
}
