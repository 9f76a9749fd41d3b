//! Warnings: what is probably not meant, but can be drawn.

use super::Step;
use std::fmt;

/// Something that is probably not meant. The picture is made all the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// Which kind.
    pub code: WarningCode,
    /// Where in the scene.
    pub place: Vec<Step>,
    /// What was found, and what is done about it.
    pub message: String,
}

macro_rules! codes {
    ($($(#[$doc:meta])* $variant:ident = $code:literal $name:literal,)*) => {
        /// Kinds of warnings. Each has a number and a name, listed in `docs/warnings.md`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum WarningCode {
            $($(#[$doc])* $variant,)*
        }

        impl WarningCode {
            /// All kinds.
            pub const ALL: &[Self] = &[$(Self::$variant,)*];

            /// Number and name, like `W001 invisible-sphere`.
            pub fn code(self) -> &'static str {
                match self { $(Self::$variant => concat!($code, " ", $name),)* }
            }
        }
    };
}

codes! {
    /// A sphere of radius 0, or scaled to it.
    InvisibleSphere = "W001" "invisible-sphere",
    /// A mesh with a transparent material in an integrator that refracts only in spheres.
    MeshNotRefracted = "W002" "mesh-not-refracted",
    /// `ko` above 1: the transparent share is negative.
    OpacityAboveOne = "W003" "opacity-above-one",
    /// Faces without area, which are left out.
    DegenerateFaces = "W004" "degenerate-faces",
    /// A vertex shared by too many faces to be smoothed.
    NotSmoothed = "W005" "not-smoothed",
    /// Something that the chosen model of light does not have.
    NotInThisModel = "W006" "not-in-this-model",
    /// A ray left a solid that it had not entered.
    StrayExit = "W007" "stray-exit",
    /// Solids of the same priority and different media that cross each other.
    Overlap = "W008" "overlap",
    /// Something between the eye and the image plane, in a model of light whose rays start on the plane.
    BeforeImagePlane = "W009" "before-image-plane",
    /// A light that stands on a surface, as far as hits can tell.
    LightOnSurface = "W010" "light-on-surface",
    /// A coefficient of a material below 0.
    NegativeCoefficient = "W011" "negative-coefficient",
    /// A name with characters that cannot be seen, or that steer a terminal.
    UnprintableName = "W012" "unprintable-name",
    /// A surface sends out light that reaches no other surface.
    EmissionLightsNothing = "W013" "emission-lights-nothing",
    /// A line that starts with an unknown word.
    UnknownKeyword = "W101" "unknown-keyword",
    /// The same setting given twice; the last one counts.
    RepeatedLine = "W102" "repeated-line",
    /// A file found in more than one place.
    AmbiguousFile = "W103" "ambiguous-file",
    /// A model without a usable material.
    NoMaterial = "W104" "no-material",
    /// A texture that is not drawn.
    TextureIgnored = "W105" "texture-ignored",
    /// Lines that fit several dialects, or none of them fully.
    UnclearDialect = "W106" "unclear-dialect",
    /// What a file of another format says has no equal in a scene.
    Approximated = "W107" "approximated",
    /// Bytes that are no text.
    NotUtf8 = "W108" "not-utf-8",
    /// Something in a model that is read but not drawn.
    NotDrawn = "W109" "not-drawn",
    /// The bounds were widened to keep pixels square.
    WidenedBounds = "W201" "widened-bounds",
    /// The light behind branches that were cut short.
    LostLight = "W202" "lost-light",
    /// Every pixel is black.
    BlackPicture = "W203" "black-picture",
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.code.code(), self.message)
    }
}
