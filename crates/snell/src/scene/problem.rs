//! Problems: why a scene cannot be drawn, and where.

use std::fmt;
use std::ops::Deref;

/// One step on the way to a value in a scene: `sphere`, `2`, `radius`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// A key of a table.
    Key(String),
    /// An element of a list, counted from 0.
    Index(usize),
}

impl From<&str> for Step {
    fn from(key: &str) -> Self {
        Self::Key(key.to_owned())
    }
}

impl From<usize> for Step {
    fn from(index: usize) -> Self {
        Self::Index(index)
    }
}

/// What helps besides a change of the scene. It is done with tools of whoever shows the problem, who names them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// To look at where a mesh is open, or its faces are turned.
    CheckMesh,
    /// To turn the faces of a mesh to one side.
    RepairMesh,
}

/// Why a scene cannot be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Where in the scene, from the root.
    pub place: Vec<Step>,
    /// What was read and what was expected.
    pub message: String,
    /// What to do about it in the scene.
    pub help: Option<String>,
    /// What to do about it elsewhere.
    pub remedy: Option<Remedy>,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.place.iter().enumerate() {
            match step {
                Step::Key(key) if i == 0 => write!(f, "{key}")?,
                Step::Key(key) => write!(f, ".{key}")?,
                Step::Index(index) => write!(f, "[{index}]")?,
            }
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for Problem {}

/// Everything that is wrong with a scene, in its order: one problem at least. Dereferences to the list.
#[derive(Clone, Debug, PartialEq)]
pub struct Problems(Vec<Problem>);

impl Problems {
    /// `None` if nothing is wrong.
    pub(super) fn of(found: Vec<Problem>) -> Option<Self> {
        (!found.is_empty()).then_some(Self(found))
    }
}

impl From<Problem> for Problems {
    fn from(problem: Problem) -> Self {
        Self(vec![problem])
    }
}

impl Deref for Problems {
    type Target = [Problem];

    fn deref(&self) -> &[Problem] {
        &self.0
    }
}

impl IntoIterator for Problems {
    type Item = Problem;
    type IntoIter = std::vec::IntoIter<Problem>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a> IntoIterator for &'a Problems {
    type Item = &'a Problem;
    type IntoIter = std::slice::Iter<'a, Problem>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

/// One problem a line.
impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.iter().enumerate() {
            write!(f, "{}{problem}", if i == 0 { "" } else { "\n" })?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}

#[cfg(test)]
mod tests {
    use crate::scene::{Integrator, Problems, Render, Scene, validate};

    fn refused() -> Problems {
        let mut scene = Scene::new(
            Render::new(Integrator::Whitted, [0, 1]),
            crate::scene::Camera::new([0.0, 0.0, 1.0], [0.0; 3], [0.0, 1.0, 0.0], [-1.0, 1.0, -1.0, 1.0], -1.0),
        );
        scene.render.spp = 0;
        validate(&scene).unwrap_err()
    }

    #[test]
    fn all_problems_are_in_the_error_each_in_its_line() {
        let problems = refused();
        let text = problems.to_string();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].starts_with("render.size: ") && lines[1].starts_with("render.spp: "), "{text}");
        assert_eq!((lines.len(), problems.len(), problems.into_iter().count()), (2, 2, 2));
    }
}
