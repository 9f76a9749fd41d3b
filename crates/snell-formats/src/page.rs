//! The page that explains a pixel: one file with the tree and the rays in 3D, which needs nothing else.

use snell::explain::{Explanation, ViewScene};
use snell::world::CompiledScene;

/// The viewer, one script, built from `viewer/` by `npm run bundle`.
pub const VIEWER: &str = include_str!("../assets/snell-viewer.js");

/// A page that opens from disk.
pub fn page(explanation: &Explanation, compiled: &CompiledScene) -> String {
    let scene = ViewScene::of(compiled);
    // Nothing in a text may end the script that holds it.
    let data = |json: serde_json::Result<String>| json.unwrap_or_default().replace('<', "\\u003c");
    let (scene, tree) = (data(serde_json::to_string(&scene)), data(serde_json::to_string(explanation)));
    let [x, y] = explanation.pixel;
    let title = format!("{} {x},{y}", explanation.scene).replace('&', "&amp;").replace('<', "&lt;");
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>body {{ margin: 0 }}</style>\n<div id=\"snell\"></div>\n<script>{VIEWER}</script>\n\
         <script>\nSnellViewer.mount(document.getElementById('snell'), {{ scene: {scene}, tree: {tree} }});\n</script>\n</html>\n"
    )
}
