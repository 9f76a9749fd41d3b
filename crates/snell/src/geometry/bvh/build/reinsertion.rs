//! Improving a binary tree: nodes are taken out and put in again where the boxes grow least (Meister and Bittner,
//! *Parallel Reinsertion for Bounding Volume Hierarchy Optimization*, 2018).

use super::collapse::{Binary, Costs};
use super::item::Extent;
use crate::threads;

/// How often nodes are moved.
const ROUNDS: usize = 2;
/// Places that are tried for a node, at most, so that the time is bounded for any tree.
const STEPS: usize = 200;

/// A node of the tree while it is changed.
#[derive(Clone, Copy)]
struct Linked {
    extent: Extent,
    area: f64,
    parent: u32,
    /// Of an inner node the children; of a leaf its place in the order of primitives, and 0, the root, which is no
    /// node's child.
    children: [u32; 2],
}

/// To take the node `from` out and to make it the sibling of `to`.
#[derive(Clone, Copy)]
struct Move {
    from: u32,
    to: u32,
    /// By how much less the surface of all boxes becomes.
    gain: f64,
}

/// Improves a tree whose leaves have one primitive each, unless it becomes deeper than `deepest`.
pub(super) fn improve(binary: Vec<Binary>, order: Vec<u32>, deepest: usize, parallel: bool) -> (Vec<Binary>, Vec<u32>) {
    let mut nodes = link(&binary);
    for _ in 0..ROUNDS {
        let mut moves = find_moves(&nodes, parallel);
        // At equal gain by number, so that the tree is always the same.
        moves.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.from.cmp(&b.from)));
        let mut moved = vec![false; nodes.len()];
        for m in moves {
            apply(&mut nodes, &m, &mut moved);
        }
    }
    if depth(&nodes) > deepest {
        return (binary, order);
    }
    drop(binary);
    let (mut improved, mut improved_order) = (Vec::with_capacity(nodes.len()), Vec::with_capacity(order.len()));
    unlink(&nodes, 0, &order, &mut improved, &mut improved_order);
    (improved, improved_order)
}

fn link(binary: &[Binary]) -> Vec<Linked> {
    let mut nodes = Vec::with_capacity(binary.len());
    let mut parents = vec![0; binary.len()];
    let mut place = 0;
    for (at, node) in binary.iter().enumerate() {
        let extent = node.extent();
        let children = if node.right == 0 {
            place += 1;
            [place - 1, 0]
        } else {
            let children = [at + 1, at + node.right as usize];
            children.map(|child| {
                parents[child] = at as u32;
                child as u32
            })
        };
        nodes.push(Linked { extent, area: extent.area(), parent: parents[at], children });
    }
    nodes
}

/// Appends what is below `at`, in order.
fn unlink(nodes: &[Linked], at: u32, order: &[u32], binary: &mut Vec<Binary>, new_order: &mut Vec<u32>) -> Costs {
    let (index, first) = (binary.len(), new_order.len());
    let Linked { extent, children: [left, right], .. } = nodes[at as usize];
    binary.push(Binary::UNFINISHED);
    let costs;
    (binary[index], costs) = if right == 0 {
        new_order.push(order[left as usize]);
        Binary::leaf(&extent, 1)
    } else {
        let left_costs = unlink(nodes, left, order, binary, new_order);
        let skip = binary.len() - index;
        let right_costs = unlink(nodes, right, order, binary, new_order);
        Binary::inner(&extent, new_order.len() - first, skip, [&left_costs, &right_costs])
    };
    costs
}

fn depth(nodes: &[Linked]) -> usize {
    let (mut deepest, mut stack) = (0, vec![(0u32, 1)]);
    while let Some((at, depth)) = stack.pop() {
        deepest = deepest.max(depth);
        let [left, right] = nodes[at as usize].children;
        if right != 0 {
            stack.extend([(left, depth + 1), (right, depth + 1)]);
        }
    }
    deepest
}

fn sibling(nodes: &[Linked], at: u32) -> u32 {
    let [left, right] = nodes[nodes[at as usize].parent as usize].children;
    if left == at { right } else { left }
}

/// The best move of each node.
fn find_moves(nodes: &[Linked], parallel: bool) -> Vec<Move> {
    const AT_ONCE: usize = 1 << 10;
    let end = nodes.len() as u32;
    let some = |first: u32| {
        let mut stack = Vec::new();
        let moves = (first..end.min(first + AT_ONCE as u32)).filter_map(|from| best_move(nodes, from, &mut stack));
        moves.collect::<Vec<Move>>()
    };
    let firsts: Vec<u32> = (1..end).step_by(AT_ONCE).collect();
    threads::map(parallel, firsts, some).concat()
}

/// Where the node `from` fits best: searched below its sibling, then below the sibling of its parent, and so on.
/// `stack`: room to work.
fn best_move(nodes: &[Linked], from: u32, stack: &mut Vec<(f64, u32)>) -> Option<Move> {
    let node = &nodes[from as usize];
    let parent = node.parent;
    if parent == 0 {
        return None; // the root stays
    }
    // What the boxes lose without it, so far as it is known; `pivot` is the node from whose other child is searched.
    let mut saved = nodes[parent as usize].area;
    let (mut pivot, mut from_below) = (parent, sibling(nodes, from));
    let mut without = nodes[from_below as usize].extent;
    let mut best = Move { from, to: 0, gain: 0.0 };
    let mut steps = 0;
    loop {
        stack.push((saved, from_below));
        while let Some((saved, at)) = stack.pop() {
            steps += 1;
            // Its new parent has at least its own surface.
            if saved - node.area <= best.gain || steps > STEPS {
                continue;
            }
            let there = &nodes[at as usize];
            let gain = saved - there.extent.join(&node.extent).area();
            if gain > best.gain {
                best = Move { from, to: at, gain };
            }
            if there.children[1] != 0 {
                let saved = gain + there.area;
                stack.push((saved, there.children[0]));
                stack.push((saved, there.children[1]));
            }
        }
        if pivot != parent {
            without = without.join(&nodes[from_below as usize].extent);
            saved += nodes[pivot as usize].area - without.area();
        }
        if pivot == 0 {
            break;
        }
        from_below = sibling(nodes, pivot);
        pivot = nodes[pivot as usize].parent;
    }
    let stays = best.to == 0 || best.to == parent || best.to == sibling(nodes, from);
    (!stays).then_some(best)
}

/// Moves a node, unless one of those concerned was moved in this round.
fn apply(nodes: &mut [Linked], m: &Move, moved: &mut [bool]) {
    let Move { from, to, .. } = *m;
    let parent = nodes[from as usize].parent;
    let (other, above) = (sibling(nodes, from), nodes[parent as usize].parent);
    let to_above = nodes[to as usize].parent;
    let concerned = [from, to, parent, other, above, to_above];
    if parent == 0 || to == parent || to == other || concerned.iter().any(|&n| moved[n as usize] && n != 0) {
        return;
    }
    // Another move may have brought `to` below `from`.
    let mut at = to;
    while at != 0 {
        if at == from {
            return;
        }
        at = nodes[at as usize].parent;
    }
    for node in concerned {
        moved[node as usize] = true;
    }
    // Its sibling takes its parent's place; its parent becomes that of `to` and of it.
    replace_child(nodes, above, parent, other);
    let to_above = nodes[to as usize].parent;
    replace_child(nodes, to_above, to, parent);
    nodes[parent as usize].children = [to, from];
    nodes[to as usize].parent = parent;
    refit(nodes, above);
    refit(nodes, parent);
}

fn replace_child(nodes: &mut [Linked], parent: u32, old: u32, new: u32) {
    for child in &mut nodes[parent as usize].children {
        if *child == old {
            *child = new;
        }
    }
    nodes[new as usize].parent = parent;
}

/// Makes the boxes fit again, from `at` upwards.
fn refit(nodes: &mut [Linked], mut at: u32) {
    loop {
        let node = nodes[at as usize];
        let [left, right] = node.children.map(|child| nodes[child as usize].extent);
        let extent = left.join(&right);
        nodes[at as usize] = Linked { extent, area: extent.area(), ..node };
        if at == 0 {
            return;
        }
        at = node.parent;
    }
}
