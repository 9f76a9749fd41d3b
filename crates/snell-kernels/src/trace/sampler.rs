//! Where in its pixel a sample looks: Sobol's sequence, scrambled after Owen, otherwise for each pixel (Burley, *Practical
//! Hash-based Owen Scrambling*, JCGT 9(4), 2020). A pure function of seed, pixel and number of the sample.

/// Right and down of the pixel's point of the grid, from −½ to below ½ each.
pub(super) fn offset(seed: u32, pixel: [u32; 2], sample: u32) -> [f64; 2] {
    let scramble = pixel.into_iter().fold(mix(seed), |hash, coordinate| mix(hash ^ coordinate));
    [0, 1].map(|dimension| f64::from(sobol_burley::sample(sample, dimension, scramble)) - 0.5)
}

/// A bijection of 32 bits that leaves no two alike near each other (Wellons' `lowbias32`).
fn mix(mut x: u32) -> u32 {
    // Without it 0 would be mapped to itself.
    x = x.wrapping_add(0x9e37_79b9);
    x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What makes it better than chance: of 4ⁿ samples one is in each cell of a grid of 2ⁿ × 2ⁿ.
    #[test]
    fn samples_are_spread_evenly() {
        for pixel in [[0, 0], [0, 1], [1, 0], [511, 4095]] {
            let mut cells = [0u32; 16 * 16];
            for sample in 0..256 {
                let [x, y] = offset(7, pixel, sample).map(|c| ((c + 0.5) * 16.0) as usize);
                cells[y * 16 + x] += 1;
            }
            assert!(cells.iter().all(|&count| count == 1), "{cells:?}");
        }
    }

    #[test]
    fn pixels_and_seeds_differ() {
        let first = offset(0, [3, 4], 0);
        for (seed, pixel) in [(1, [3, 4]), (0, [4, 3]), (0, [3, 5])] {
            assert_ne!(offset(seed, pixel, 0), first);
        }
    }
}
