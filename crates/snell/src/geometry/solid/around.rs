//! Which faces around an edge belong together, where there are more than two.

use super::exact::{broadside, side, turn};
use super::topology::Use;
use crate::geometry::Vec3;
use std::cmp::Ordering;

/// Pairs of uses of one edge between which a solid lies; `None` where that cannot be said, because the faces do not pass the
/// edge equally often in both directions or one of them is a line.
///
/// Going around the edge, a solid begins behind a face that looks back and ends at one that looks ahead. So the faces are
/// sorted by angle and paired like brackets. Where two lie in one place, the solid behind it ends before the next begins:
/// touching solids stay two.
pub(super) fn pairs(uses: &[Use], corners: &[[u32; 3]], points: &[Vec3]) -> Option<Vec<(Use, Use)>> {
    let balance: i64 = uses.iter().map(|u| if u.forward { 1 } else { -1 }).sum();
    let [a, b] = uses[0].ends.map(|v| points[v as usize]);
    let tip = |u: &Use| {
        let other = corners[u.face as usize].into_iter().find(|v| !u.ends.contains(v));
        other.map_or(a, |v| points[v as usize])
    };
    let first = tip(&uses[0]);
    let axis = broadside([a, b, first])?;
    if balance != 0 || uses.iter().any(|u| broadside([a, b, tip(u)]).is_none()) {
        return None;
    }
    // A quarter of the way around: with the first face, in the half before the opposite one, opposite, in the other half.
    let quarter = |p: Vec3| match side([a, b, first], p) {
        0 if turn(axis, a, b, p) == turn(axis, a, b, first) => 0,
        -1 => 1,
        0 => 2,
        _ => 3,
    };
    let mut sorted: Vec<(i32, Vec3, Use)> = uses.iter().map(|u| (quarter(tip(u)), tip(u), *u)).collect();
    let angle = |p: &(i32, Vec3, Use), q: &(i32, Vec3, Use)| {
        let within = if p.0 == q.0 && p.0 % 2 == 1 { side([a, b, p.1], q.1).cmp(&0) } else { Ordering::Equal };
        p.0.cmp(&q.0).then(within).then(q.2.forward.cmp(&p.2.forward)).then(p.2.face.cmp(&q.2.face))
    };
    sorted.sort_by(angle);
    // Brackets start where fewest are open.
    let mut open = 0i64;
    let depths = sorted.iter().map(|(.., u)| {
        open += if u.forward { -1 } else { 1 };
        open
    });
    let start = depths.enumerate().min_by_key(|(_, depth)| *depth).map_or(0, |(i, _)| i + 1);
    let (mut begun, mut pairs) = (Vec::new(), Vec::new());
    for (.., u) in sorted.iter().cycle().skip(start).take(sorted.len()) {
        if u.forward {
            pairs.extend(begun.pop().map(|other| (other, *u)));
        } else {
            begun.push(*u);
        }
    }
    Some(pairs)
}
