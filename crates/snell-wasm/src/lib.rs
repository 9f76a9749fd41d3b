//! Snell in a browser tab: what is handed over and back. No physics, and no settings of its own.
//!
//! ```text
//!  JavaScript                        snell-wasm                                       the library
//!  Session.load(name, text, files) ▶ session: a scene as text, its files, its world ▶ load_bytes, CompiledScene
//!  edit(changes), revise(text) ────▶ the same with another text ────────────────────▶ scene_file::rewrite, CompiledScene::edited
//!  begin(options), step(ms) ───────▶ picture: pieces that come tile by tile ────────▶ Renderer
//!  rgba(x, y, width, height) ◀────── copies of its numbers ◀──────────────────────── Film, Encoding
//!  explain(x, y), view() ◀────────── JSON ◀───────────────────────────────────────── explain, ViewScene
//! ```
//!
//! The scene is its text: every edit changes that, and the text is read again, so that the two cannot disagree.
//!
//! An instance of the module has one thread. A pool of workers has an instance each: they render a share of the picture
//! (`share`), and one of them may gather what they have made (`gather`, `put`, `put_lost`, `put_statistics`).
//!
//! ```js
//! import init, { Session } from "./snell_wasm.js";
//! await init();
//! const session = Session.builtin("lecture/default");
//! session.begin('{ "coarsest": 8 }');
//! while (!session.is_finished) show(session.step(16));
//! ```
//!
//! Whatever is refused is thrown as an `Error` with `findings`, a JSON text: a list of `message`, `help`, `code` and `place`.

#![allow(missing_debug_implementations, reason = "JavaScript shows them by its own classes")]
#![allow(clippy::needless_pass_by_value, reason = "what JavaScript hands over comes by value")]

#[cfg(all(target_family = "wasm", not(target_feature = "simd128")))]
compile_error!("this is to be built with simd128: is RUSTFLAGS set, or .cargo/config.toml not read?");

mod findings;
mod gathered;
mod page;
mod part;
mod picture;
mod pieces;
mod ready;
mod session;
