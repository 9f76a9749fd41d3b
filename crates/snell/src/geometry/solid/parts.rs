//! Union-find that remembers who is turned against whom.

/// Disjoint sets of faces (Tarjan 1975, by size, with path halving), each face turned or not against the root of its set.
#[derive(Debug)]
pub(super) struct Parts {
    parent: Vec<u32>,
    /// Is it turned against its parent?
    turned: Vec<bool>,
    size: Vec<u32>,
    /// Faces that were asked to be turned against what they are already.
    pub contradictions: Vec<u32>,
}

impl Parts {
    pub fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
            turned: vec![false; count],
            size: vec![1; count],
            contradictions: Vec::new(),
        }
    }

    /// The root of a face's set, and whether the face is turned against it.
    pub fn find(&mut self, face: u32) -> (u32, bool) {
        let (mut at, mut turned) = (face as usize, false);
        loop {
            let parent = self.parent[at] as usize;
            if parent == at {
                return (at as u32, turned);
            }
            self.turned[at] ^= self.turned[parent];
            self.parent[at] = self.parent[parent];
            turned ^= self.turned[at];
            at = self.parent[at] as usize;
        }
    }

    /// Joins the sets of two faces, so that they are turned against each other or not.
    pub fn join(&mut self, a: u32, b: u32, turned: bool) {
        let ((a_root, a_turned), (b_root, b_turned)) = (self.find(a), self.find(b));
        let turned = turned ^ a_turned ^ b_turned;
        if a_root == b_root {
            if turned {
                self.contradictions.push(a);
            }
            return;
        }
        let swap = self.size[a_root as usize] < self.size[b_root as usize];
        let (root, child) = if swap { (b_root, a_root) } else { (a_root, b_root) };
        self.parent[child as usize] = root;
        self.turned[child as usize] = turned;
        self.size[root as usize] += self.size[child as usize];
    }
}
