//! Models: OBJ and MTL, and where they lie.

mod mtl;
mod obj;
mod search;

pub use mtl::{Mirror, MtlMaterial, MtlRule, parse_mtl};
pub use obj::{ObjModel, parse_obj};
pub use search::{Found, find};
