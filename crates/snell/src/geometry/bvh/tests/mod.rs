//! Traversal finds what the bare tests find, in trees as they are built.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod crossings;
mod instance;
mod tree;
