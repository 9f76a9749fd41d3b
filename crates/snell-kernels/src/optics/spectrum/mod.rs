//! Wavelengths and colours: how single wavelengths look, and white light cut into bands.

mod cie;

use super::dispersion::{LINE_D_NM, VISIBLE_NM};
use crate::color::Rgb;
use alloc::vec;
use alloc::vec::Vec;

/// Linear sRGB of the tristimulus values X, Y, Z: the primaries and the white of IEC 61966-2-1 (ITU-R BT.709), solved for
/// 16 digits.
const XYZ_TO_SRGB: [[f64; 3]; 3] = [
    [3.240_969_941_904_522_6, -1.537_383_177_570_094, -0.498_610_760_293_003_4],
    [-0.969_243_636_280_879_6, 1.875_967_501_507_720_2, 0.041_555_057_407_175_59],
    [0.055_630_079_696_993_66, -0.203_976_958_888_976_52, 1.056_971_514_242_878_6],
];

/// A part of white light that goes its own way through a dispersive glass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// The wavelength in nm that stands for all of it, with whose index it is refracted.
    pub wavelength_nm: f64,
    /// What it adds to each channel of linear sRGB, as a part of white. May be negative: light of one wavelength is more
    /// colourful than the primaries of a screen.
    pub weight: Rgb,
}

/// CIE 1931 tristimulus values of light of one wavelength in nm, by the observer of 2°; Y is 1 at 555 nm. 0 outside of 380 to
/// 780 nm. On straight lines between the 5 nm of the CIE's table: off by up to 0.017, Z near 418 nm, where it is 0.52.
pub fn xyz(wavelength_nm: f64) -> [f64; 3] {
    let [x, y, z, _] = cie::at(wavelength_nm);
    [x, y, z]
}

/// Relative power of daylight, the CIE's illuminant D65, by wavelength in nm: 100 at 560 nm, 0 outside of 380 to 780 nm.
pub fn d65(wavelength_nm: f64) -> f64 {
    cie::at(wavelength_nm)[3]
}

/// Linear sRGB of tristimulus values: (1, 1, 1) for the chromaticity of D65 and Y = 1. Negative for colours that a screen
/// cannot show.
pub fn linear_srgb(xyz: [f64; 3]) -> Rgb {
    XYZ_TO_SRGB.map(|[x, y, z]| x * xyz[0] + y * xyz[1] + z * xyz[2]).into()
}

/// White light (daylight, D65, which is white in sRGB) cut into so many bands, from violet to red.
///
/// The cuts are where each band has the same share of `D65·(|R| + |G| + |B|)`, so that every ray of a split one matters as
/// much to the picture; its wavelength is the mean of its band by the same measure. One band is all of white, at the d line,
/// for which indices of glasses are given. Twice as many bands halve each band: the weights of the halves add up to it.
///
/// The weights of all bands add up to exactly 1 in each channel, in any order of addition: they are multiples of 2⁻⁴⁸, so
/// no sum is rounded. Dispersion that goes to nothing leaves no trace. None for a `count` of 0.
pub fn bands(count: usize) -> Vec<Band> {
    if count == 1 {
        return vec![Band { wavelength_nm: LINE_D_NM, weight: Rgb::gray(1.0) }];
    }
    let slices = slices();
    let all = up_to(&slices, f64::INFINITY);
    let mut before = (Slice::default(), Rgb::gray(0.0));
    let mut bands = Vec::with_capacity(count);
    for i in 1..=count {
        // What has gone by, and as a part of white.
        let after = if i == count {
            (all, Rgb::gray(1.0))
        } else {
            let sum = up_to(&slices, all.amount * (i as f64 / count as f64));
            (sum, Rgb::new(on_grid(sum.r / all.r), on_grid(sum.g / all.g), on_grid(sum.b / all.b)))
        };
        bands.push(Band {
            wavelength_nm: (after.0.moment - before.0.moment) / (after.0.amount - before.0.amount),
            weight: after.1 - before.1,
        });
        before = after;
    }
    bands
}

/// The nearest multiple of 2⁻⁴⁸, of numbers that are not large: far below what the table knows.
fn on_grid(x: f64) -> f64 {
    const TO_48_BITS: f64 = 24.0; // 1.5·2^4, whose last bit is 2^-48
    (x + TO_48_BITS) - TO_48_BITS
}

/// A thin slice of white light, or several: its linear sRGB, its share of the picture, and that times the wavelength.
#[derive(Clone, Copy, Debug, Default)]
struct Slice {
    r: f64,
    g: f64,
    b: f64,
    amount: f64,
    moment: f64,
}

impl Slice {
    fn plus(self, other: Self, part: f64) -> Self {
        Self {
            r: self.r + other.r * part,
            g: self.g + other.g * part,
            b: self.b + other.b * part,
            amount: self.amount + other.amount * part,
            moment: self.moment + other.moment * part,
        }
    }
}

/// White light, nanometre by nanometre.
fn slices() -> Vec<Slice> {
    let [first, last] = VISIBLE_NM;
    let count = (last - first) as usize;
    let slice = |i: usize| {
        let wavelength_nm = first + (i as f64 + 0.5);
        let power = d65(wavelength_nm);
        let Rgb { r, g, b } = linear_srgb(xyz(wavelength_nm).map(|value| value * power));
        let amount = r.abs() + g.abs() + b.abs();
        Slice { r, g, b, amount, moment: amount * wavelength_nm }
    };
    (0..count).map(slice).collect()
}

/// The sum of the first slices, as many and as much of the last one as make up `amount`; of all if there is no more.
fn up_to(slices: &[Slice], amount: f64) -> Slice {
    let mut sum = Slice::default();
    for &slice in slices {
        let missing = amount - sum.amount;
        if slice.amount >= missing {
            return sum.plus(slice, missing / slice.amount);
        }
        sum = sum.plus(slice, 1.0);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chromaticity([x, y, z]: [f64; 3]) -> [f64; 2] {
        [x / (x + y + z), y / (x + y + z)]
    }

    /// The sums that belong to the table (Wyszecki and Stiles, "Color Science", 2nd edition, 1982), which find a
    /// wrong entry of the first three columns; and the white point of D65 (CIE 15:2004, table T.3) for the fourth.
    #[test]
    fn the_tables_are_those_of_the_cie() {
        let sum = |column: usize| cie::TABLE.iter().map(|row| row[column]).sum::<f64>();
        for (found, known) in [sum(0), sum(1), sum(2)].into_iter().zip([21.371_524, 21.371_327, 21.371_540]) {
            // Six digits, added exactly but for roundings.
            assert!((found - known).abs() < 1e-12, "{found}");
        }
        let white = [0, 1, 2].map(|column| cie::TABLE.iter().map(|row| row[column] * row[3]).sum::<f64>());
        for (found, known) in white.into_iter().zip([95.04, 100.0, 108.88]) {
            assert!((found / white[1] * 100.0 - known).abs() < 0.005, "{found}");
        }
        for (found, known) in chromaticity(white).into_iter().zip([0.312_72, 0.329_03]) {
            assert!((found - known).abs() < 1e-5, "{found}");
        }
        assert_eq!((d65(560.0), xyz(555.0)), (100.0, [0.51205, 1.0, 0.00575]));
        assert_eq!((xyz(379.9), d65(780.1), xyz(f64::NAN)), ([0.0; 3], 0.0, [0.0; 3]));
        assert_eq!((xyz(780.0), d65(380.0)), ([0.000_042, 0.000_015, 0.0], 49.9755), "both ends belong to it");
    }

    #[test]
    fn spectral_colours_are_where_the_diagram_has_them() {
        for (wavelength_nm, known) in [
            (450.0, [0.1566, 0.0177]),
            (480.0, [0.0913, 0.1327]),
            (520.0, [0.0743, 0.8338]),
            (550.0, [0.3016, 0.6923]),
            (600.0, [0.6270, 0.3725]),
            (700.0, [0.7347, 0.2653]),
        ] {
            for (found, known) in chromaticity(xyz(wavelength_nm)).into_iter().zip(known) {
                assert!((found - known).abs() < 0.51e-4, "{wavelength_nm} nm: {found}"); // four digits
            }
        }
        // The sodium line, between two entries, by the CIE's table of every 1 nm; a chord of 5 nm is off by 1.5e-4 there.
        let [x, y] = chromaticity(xyz(589.3));
        assert!((x - 0.571_02).abs() < 2e-4 && (y - 0.428_34).abs() < 2e-4, "{x} {y}");
    }

    #[test]
    fn srgb_has_its_primaries_and_white() {
        // IEC 61966-2-1, as exact numbers: x, y of red, green, blue; white 0.3127, 0.3290.
        let of = |[x, y]: [f64; 2]| linear_srgb([x / y, 1.0, (1.0 - x - y) / y]).to_array();
        for (channel, primary) in [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]].into_iter().enumerate() {
            for (other, value) in of(primary).into_iter().enumerate() {
                // Roundings of numbers up to 3.2·13.
                assert!(other == channel || value.abs() < 2e-14, "{value}");
            }
        }
        for value in of([0.3127, 0.3290]) {
            assert!((value - 1.0).abs() < 2e-15);
        }
    }

    #[test]
    fn bands_add_up_to_white_exactly_and_in_any_order() {
        for count in 1..=64 {
            let bands = bands(count);
            assert_eq!(bands.len(), count);
            let there = bands.iter().fold(Rgb::gray(0.0), |sum, band| sum + band.weight);
            let back = bands.iter().rev().fold(Rgb::gray(0.0), |sum, band| sum + band.weight);
            assert_eq!((there, back), (Rgb::gray(1.0), Rgb::gray(1.0)), "{count} bands");
            assert!(bands.windows(2).all(|pair| pair[0].wavelength_nm < pair[1].wavelength_nm));
            let [first, last] = VISIBLE_NM;
            assert!(bands.iter().all(|band| first < band.wavelength_nm && band.wavelength_nm < last));
        }
        assert_eq!(bands(1), [Band { wavelength_nm: 587.5618, weight: Rgb::gray(1.0) }]);
        assert_eq!(bands(0), []);
    }

    #[test]
    fn bands_have_their_colours() {
        let three = bands(3).into_iter().map(|band| band.weight);
        for (channel, weight) in [2, 1, 0].into_iter().zip(three) {
            let weight = weight.to_array();
            assert!(
                (0..3).all(|other| other == channel || weight[other] < weight[channel]),
                "blue, green, red: {weight:?}"
            );
        }
        assert!(bands(8).iter().any(|band| band.weight.r < -0.1), "cyan lacks red");
    }

    #[test]
    fn twice_as_many_bands_are_halves_of_them() {
        for count in 2..=32 {
            for (whole, halves) in bands(count).into_iter().zip(bands(2 * count).chunks(2)) {
                assert_eq!(halves[0].weight + halves[1].weight, whole.weight);
                // Equal shares: the mean of the means, but for roundings of sums of 400 numbers up to 1e5 in differences
                // that are 1/64 of them.
                let mean = 0.5 * (halves[0].wavelength_nm + halves[1].wavelength_nm);
                assert!((mean - whole.wavelength_nm).abs() < 1e-8, "{mean}");
            }
        }
    }
}
