//! The scenes that every Snell carries: all pictures of the lecture, a view to study, and the gallery.

use crate::report::{Remedy, Report, Source, nearest};

macro_rules! scenes {
    ($($name:literal),* $(,)?) => {
        /// Names and texts, in the order of the lecture, then what is studied, then the gallery.
        pub const SCENES: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../../scenes/", $name, ".toml")))),*];
    };
}

scenes![
    "lecture/default",
    "lecture/no-shadows",
    "lecture/no-glass",
    "lecture/eta-1.0",
    "lecture/eta-1.05",
    "lecture/germanium",
    "lecture/diamond",
    "lecture/diamond-depth-1",
    "lecture/diamond-depth-2",
    "lecture/diamond-depth-3",
    "lecture/diamond-depth-4",
    "lecture/diamond-depth-5",
    "lecture/diamond-depth-6",
    "lecture/wide",
    "lecture/quarter",
    "study/quarter-view",
    "gallery/ball",
    "gallery/ice",
    "gallery/prism",
    "gallery/brilliant",
    "gallery/bubbles",
    "gallery/window",
    "gallery/lens",
    "gallery/plates",
    "gallery/pencil",
];

/// The text of a built-in scene.
///
/// # Errors
/// When there is none of this name.
pub fn find(name: &str) -> Result<Source, Report> {
    if let Some((name, text)) = SCENES.iter().find(|(n, _)| *n == name) {
        Ok(Source::new(*name, *text))
    } else {
        // `ball` is short for `gallery/ball`.
        let end = SCENES.iter().map(|(n, _)| *n).find(|n| n.rsplit('/').next() == Some(name));
        let near = end.or_else(|| nearest(name, SCENES.iter().map(|(n, _)| *n)));
        let report = Report::error(format!("no built-in scene is called `{name}`")).remedy(Remedy::ListScenes);
        Err(near.into_iter().fold(report, |report, near| report.help(format!("did you mean `{near}`?"))))
    }
}

/// The comment at the top of a scene text, one string per paragraph line, without the `#`.
pub fn description(text: &str) -> Vec<&str> {
    text.lines().map_while(|line| line.strip_prefix('#')).map(str::trim).collect()
}
