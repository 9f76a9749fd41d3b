//! In which order tiles are rendered.

/// An order in which every number below `count` comes once, each far from the last ones: steps of the golden ratio leave no large
/// gap (Weyl 1916). Sky and glass take turns, so that the tiles that are finished tell how long the others will take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    pub count: u64,
    step: u64,
}

impl Spread {
    pub fn new(count: u64) -> Self {
        let gcd = |mut a: u64, mut b: u64| {
            while b != 0 {
                (a, b) = (b, a % b);
            }
            a
        };
        let golden = (count as f64 * 0.618_033_988_749_895) as u64;
        let step = (golden.max(1)..=count).find(|&step| gcd(step, count) == 1).unwrap_or(1);
        Self { count, step }
    }

    pub fn nth(self, turn: u64) -> u64 {
        (u128::from(turn) * u128::from(self.step) % u128::from(self.count)) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::Spread;

    #[test]
    fn every_number_has_its_turn_and_neighbours_in_time_are_far_apart() {
        for count in 1..300 {
            let spread = Spread::new(count);
            let order: Vec<u64> = (0..count).map(|turn| spread.nth(turn)).collect();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..count).collect::<Vec<_>>());
            // Halves are sampled evenly from the first tenth on, so that a rate tells the time left.
            let begun = &order[..count.div_ceil(10) as usize];
            let upper = begun.iter().filter(|&&band| band < count / 2).count();
            assert!(upper.abs_diff(begun.len() - upper) <= 1 + begun.len() / 4, "{count}: {begun:?}");
        }
    }
}
