//! The round brilliant, from the proportions that a grading report states.

use crate::convex::{HalfSpace, Polyhedron, polyhedron};
use snell::geometry::Vec3;
use snell::lanes::elementary::sin_cos_degrees;

/// The proportions of a round brilliant. Lengths are shares of its diameter, angles are in degrees against the girdle plane.
///
/// Stars and halves are not asked for by their angles: these follow from where they meet.
#[derive(Clone, Copy, Debug)]
pub struct Cut {
    /// From corner to opposite corner of the table.
    pub table: f64,
    /// Angle of the bezel facets.
    pub crown: f64,
    /// Angle of the pavilion mains.
    pub pavilion: f64,
    /// Thickness of the girdle where it is thickest: at the mains, and between them.
    pub girdle: f64,
    /// Seen from above, how far the stars reach from the edge of the table to the girdle: 0 to 1.
    pub star: f64,
    /// Seen from below, how far the lower girdle facets reach from the girdle to the culet: 0 to 1.
    pub lower: f64,
    /// Number of the girdle's flat facets, a multiple of 16.
    pub girdle_facets: u32,
}

/// Tolkowsky's table and angles (*Diamond Design*, 1919); the rest is what is usual today, he does not say it.
impl Default for Cut {
    fn default() -> Self {
        Self { table: 0.53, crown: 34.5, pavilion: 40.75, girdle: 0.03, star: 0.5, lower: 0.77, girdle_facets: 64 }
    }
}

/// What a facet is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facet {
    /// The octagon on top.
    Table,
    /// A triangle at an edge of the table.
    Star,
    /// A kite from a corner of the table to the girdle: a main facet of the crown.
    Bezel,
    /// Half of what is between two kites, from the star's tip to the girdle.
    UpperGirdle,
    /// A flat of the girdle, upright.
    Girdle,
    /// Half of what is between two pavilion mains at the girdle.
    LowerGirdle,
    /// From the girdle to the culet: a main facet of the pavilion.
    Pavilion,
}

/// A cut stone: diameter 1, the axis along y, the table up, the middle of the girdle at y = 0, the culet a point.
#[derive(Clone, Debug)]
pub struct Brilliant {
    /// What the facets of `solid` are, in the same order.
    pub kinds: Vec<Facet>,
    /// Vertices and facets.
    pub solid: Polyhedron,
}

/// A point of the stone's profile: distance from the axis, height.
type Profile = [f64; 2];

impl Cut {
    /// Height of the table above the upper edge of the girdle: the bezels rise from the girdle to the table's corners.
    pub fn crown_height(&self) -> f64 {
        (1.0 - self.table) / 2.0 * tan(self.crown)
    }

    /// Depth of the culet below the lower edge of the girdle: the pavilion mains fall from the girdle to the axis.
    pub fn pavilion_depth(&self) -> f64 {
        tan(self.pavilion) / 2.0
    }

    /// Cuts the stone.
    ///
    /// # Panics
    /// When a facet does not show: with a girdle so thin that the halves above and below meet, for example.
    pub fn brilliant(&self) -> Brilliant {
        let facets = self.facets();
        let kinds = facets.iter().map(|&(kind, _)| kind).collect();
        let solid = polyhedron(&facets.into_iter().map(|(_, side)| side).collect::<Vec<_>>());
        assert!(solid.facets.iter().all(|facet| facet.len() >= 3), "a facet does not show: {self:?}");
        Brilliant { kinds, solid }
    }

    /// All facets' planes.
    ///
    /// The mains stand at azimuths 0°, 45°, …, and the girdle is a polygon whose corners lie on the circle, some of them at
    /// the tips of the mains and midway between them. Two neighbouring mains share an edge at azimuth 22.5° up to a
    /// junction, at distance `j` from the axis and at the height `(1/2 − j·cos 22.5°)·tan(main)` above the girdle. There a
    /// half begins. It ends in the chord of the girdle between the tip of a main and the point midway to the next, both
    /// at the girdle's edge; so it looks towards 11.25°, where the chord is `cos 11.25°/2` from the axis and the junction
    /// `j·cos 11.25°`, and its angle follows. Between the chord's ends it cuts into the girdle, which is why girdles are scalloped.
    /// A star goes from an edge of the table to the junction of the crown.
    fn facets(&self) -> Vec<(Facet, HalfSpace)> {
        let [cos_half, cos_quarter] = [22.5, 11.25].map(|degrees| sin_cos_degrees(degrees).1);
        let above = self.girdle / 2.0;
        // From the axis to the middles of the table's edges.
        let edge = self.table / 2.0 * cos_half;
        let rise = |distance: f64, main: f64| (0.5 - distance * cos_half) * tan(main);
        let star: Profile = {
            let distance = edge + self.star * (0.5 - edge);
            [distance, above + rise(distance, self.crown)]
        };
        let lower: Profile = {
            let distance = (1.0 - self.lower) / 2.0;
            [distance, -above - rise(distance, self.pavilion)]
        };
        let top = above + self.crown_height();
        let culet = -above - self.pavilion_depth();
        let towards_quarter = |[distance, height]: Profile| [distance * cos_quarter, height];

        let flats = self.girdle_facets;
        let half_a_flat = 180.0 / f64::from(flats);
        let girdle = 0.5 * sin_cos_degrees(half_a_flat).1;
        let mut facets = vec![(Facet::Table, HalfSpace { normal: Vec3::new(0.0, 1.0, 0.0), offset: top })];
        let mut ring = |kind: Facet, count: u32, first: f64, profile: [Profile; 2]| {
            let azimuths = (0..count).map(|i| first + 360.0 * f64::from(i) / f64::from(count));
            facets.extend(azimuths.map(|azimuth| (kind, facet(azimuth, profile))));
        };
        ring(Facet::Star, 8, 22.5, [star, [edge, top]]);
        ring(Facet::Bezel, 8, 0.0, [[0.5, above], [self.table / 2.0, top]]);
        ring(Facet::UpperGirdle, 16, 11.25, [[0.5, above], star].map(towards_quarter));
        ring(Facet::Girdle, flats, half_a_flat, [[girdle, -above], [girdle, above]]);
        ring(Facet::LowerGirdle, 16, 11.25, [lower, [0.5, -above]].map(towards_quarter));
        ring(Facet::Pavilion, 8, 0.0, [[0.0, culet], [0.5, -above]]);
        facets
    }
}

/// The plane that looks towards an azimuth and has this profile there, from its lower to its upper point.
fn facet(azimuth: f64, [low, high]: [Profile; 2]) -> HalfSpace {
    let (sin, cos) = sin_cos_degrees(azimuth);
    let (run, rise) = (high[0] - low[0], high[1] - low[1]);
    let normal = Vec3::new(rise * cos, -run, rise * sin).unit();
    let point = Vec3::new(low[0] * cos, low[1], low[0] * sin);
    HalfSpace { normal, offset: normal.dot(point) }
}

fn tan(degrees: f64) -> f64 {
    let (sin, cos) = sin_cos_degrees(degrees);
    sin / cos
}

#[cfg(test)]
mod tests {
    use super::Facet::{Bezel, Girdle, LowerGirdle, Pavilion, Star, Table, UpperGirdle};
    use super::*;
    use snell::geometry::solid::{Verdict, check};

    /// Coordinates are below 1 and come from a few dozen roundings.
    const ROUNDING: f64 = 1e-14;

    fn corners(stone: &Brilliant, kind: Facet) -> impl Iterator<Item = Vec<Vec3>> {
        let facets = stone.kinds.iter().zip(&stone.solid.facets).filter(move |(k, _)| **k == kind);
        facets.map(|(_, facet)| facet.iter().map(|&v| stone.solid.vertices[v as usize]).collect())
    }

    /// Distance from the axis.
    fn out(p: Vec3) -> f64 {
        (p.x * p.x + p.z * p.z).sqrt()
    }

    #[test]
    fn it_is_one_solid_with_the_facets_of_a_brilliant() {
        for girdle_facets in [32, 64] {
            let stone = Cut { girdle_facets, ..Cut::default() }.brilliant();
            // Of each kind: how many, and with how many corners.
            let flats = girdle_facets as usize;
            let kinds = [(Table, 1, 8), (Star, 8, 3), (Bezel, 8, 4), (UpperGirdle, 16, 2 + flats / 16)];
            let below = [(Girdle, flats, 4), (LowerGirdle, 16, 2 + flats / 16), (Pavilion, 8, 4)];
            for (kind, count, shape) in kinds.into_iter().chain(below) {
                let found: Vec<usize> = corners(&stone, kind).map(|corners| corners.len()).collect();
                assert_eq!(found, vec![shape; count], "{kind:?}");
            }
            let report = check(&stone.solid.mesh());
            assert_eq!((report.verdict(), report.components.len(), report.euler()), (Verdict::Solid, 1, 2));
            assert!(report.degenerate.is_empty() && report.crossing.is_empty() && report.complete);
        }
    }

    #[test]
    fn the_proportions_are_those_asked_for() {
        let cut = Cut::default();
        let stone = cut.brilliant();
        let close = |a: f64, b: f64| assert!((a - b).abs() < ROUNDING, "{a} {b}");
        for (kind, degrees) in [(Bezel, cut.crown), (Pavilion, cut.pavilion)] {
            for corners in corners(&stone, kind) {
                // Along the facet, from its tip at the girdle to the corner across: the steepest way.
                let tip = (0..4).max_by(|&a, &b| out(corners[a]).total_cmp(&out(corners[b]))).unwrap();
                let way = corners[(tip + 2) % 4] - corners[tip];
                close(way.y.abs(), tan(degrees) * (out(corners[tip]) - out(corners[(tip + 2) % 4])));
                close(out(corners[tip]), 0.5);
            }
        }
        for corners in corners(&stone, Table) {
            for corner in corners {
                close(out(corner), cut.table / 2.0);
            }
        }
        let edge = cut.table / 2.0 * sin_cos_degrees(22.5).1;
        for corners in corners(&stone, Star) {
            let tip = corners.into_iter().map(out).fold(0.0, f64::max);
            close((tip - edge) / (0.5 - edge), cut.star);
        }
        for corners in corners(&stone, LowerGirdle) {
            let tip = corners.into_iter().map(out).fold(0.5, f64::min);
            close((0.5 - tip) / 0.5, cut.lower);
        }
        let heights = || stone.solid.vertices.iter().map(|p| p.y);
        let total = heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min);
        close(total, cut.crown_height() + cut.girdle + cut.pavilion_depth());
        // As Tolkowsky states them, in hundredths of the diameter.
        let stated = |height: f64| (1000.0 * height).round() / 10.0;
        assert_eq!([cut.crown_height(), cut.pavilion_depth()].map(stated), [16.2, 43.1]);
    }

    #[test]
    fn it_is_convex_and_looks_the_same_from_eight_sides_and_in_a_mirror() {
        let cut = Cut::default();
        let vertices = cut.brilliant().solid.vertices;
        for (_, side) in cut.facets() {
            assert!(vertices.iter().all(|&p| side.distance(p) < ROUNDING));
        }
        let (sin, cos) = sin_cos_degrees(45.0);
        for &Vec3 { x, y, z } in &vertices {
            for image in [Vec3::new(x * cos - z * sin, y, x * sin + z * cos), Vec3::new(x, y, -z)] {
                assert!(vertices.iter().any(|&p| (p - image).length() < ROUNDING), "{image:?}");
            }
        }
    }
}
