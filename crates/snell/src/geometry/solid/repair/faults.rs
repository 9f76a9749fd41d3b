//! Is a mesh worse than it was?

use super::super::{Outline, Verdict};
use crate::geometry::TriangleMesh;

/// What repair may not make more of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Faults {
    /// Edges with an odd number of faces: where the surface is open.
    open: usize,
    /// Edges that are not passed by two faces, once in each direction.
    edges: usize,
    verdict: Verdict,
}

impl Faults {
    pub fn of(mesh: &TriangleMesh) -> Self {
        let mut outline = Outline::of(mesh);
        outline.find_cavities();
        let Outline { topology, report, .. } = outline;
        Self {
            open: topology.open_edges().count(),
            edges: topology.edges().filter(|edge| !matches!(edge, [a, b] if a.forward != b.forward)).count(),
            verdict: report.verdict(),
        }
    }

    /// Edges of one kind may become more where those of others become fewer by as many: cubes that are closed may share an
    /// edge, which then has four faces. But nothing is worth an open edge, a solid, or all that is there.
    pub fn worse_than(&self, before: &Self) -> bool {
        let rank = |verdict| match verdict {
            Verdict::Solid => 3,
            Verdict::InsideOut => 2,
            Verdict::Flat | Verdict::Misoriented | Verdict::Open => 1,
            Verdict::Empty => 0,
        };
        self.open > before.open || self.edges > before.edges || rank(self.verdict) < rank(before.verdict)
    }
}
