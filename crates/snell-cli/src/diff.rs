//! `snell diff`.

use crate::args::DiffArgs;
use crate::output::refuse_inputs;
use crate::say::{self, FAILED, Failure, OrFail, Outcome, USAGE, tell};
use snell::film::transfer::Encoding;
use snell::film::{Crop, Film, Rgb};
use snell::scene::{Rounding, Transfer};
use snell_formats::Report;
use snell_formats::picture::{self, Format, Picture, Writing};

pub fn run(args: &DiffArgs) -> Outcome {
    if args.tolerance.is_nan() || args.tolerance < 0.0 {
        return Err(Failure::new(USAGE, Report::error("a tolerance is a number from 0 on")));
    }
    let format = args.output.as_deref().map(Format::of).transpose().or_fail(USAGE)?;
    if let Some(output) = &args.output {
        refuse_inputs(output, [args.a.as_path(), args.b.as_path()])?;
    }
    let (a, b) = (picture::read(&args.a).or_fail(FAILED)?, picture::read(&args.b).or_fail(FAILED)?);
    if (a.width, a.height) != (b.width, b.height) {
        let message = format!("the sizes differ: {} x {} and {} x {}", a.width, a.height, b.width, b.height);
        return Err(Failure::new(FAILED, Report::error(message)));
    }
    let (unit, a_scale, b_scale) = match (a.max, b.max) {
        (Some(a), Some(b)) => (" of 255", 255.0 / f64::from(a), 255.0 / f64::from(b)),
        (None, None) => ("", 1.0, 1.0),
        (a, b) => {
            tell("note: one picture holds integers, the other linear numbers; compared as 0 to 1");
            ("", 1.0 / f64::from(a.unwrap_or(1)), 1.0 / f64::from(b.unwrap_or(1)))
        }
    };
    let differences: Vec<Rgb> =
        a.pixels.iter().zip(&b.pixels).map(|(&p, &q)| difference(p * a_scale, q * b_scale)).collect();
    let compared = Comparison::new(&a, &differences, args.tolerance);
    say::print(&compared.describe(unit, args.tolerance))?;
    if let (Some(output), Some(format)) = (&args.output, format) {
        // The largest finite difference is white; an infinite one (NaN against a number) too.
        let finite = differences.iter().flat_map(|d| d.to_array()).filter(|d| d.is_finite()).fold(0.0, f64::max);
        let brighten = |d: f64| if d.is_finite() { d / finite.max(f64::MIN_POSITIVE) } else { 1.0 };
        let crop = Crop { x: 0, y: 0, width: a.width as u32, height: a.height as u32 };
        let film = Film {
            full_size: [crop.width, crop.height],
            crop,
            pixels: differences.iter().map(|d| d.to_array().map(brighten).into()).collect(),
            finished: vec![true; differences.len()],
        };
        let encoding = Encoding { transfer: Transfer::Linear, rounding: Rounding::Round };
        Writing { format, encoding, threads: 0 }.write(output, &film, None).or_fail(FAILED)?;
    }
    if compared.max > args.tolerance { Err(Failure { code: FAILED, reports: Vec::new() }) } else { Ok(()) }
}

fn difference(a: Rgb, b: Rgb) -> Rgb {
    let channel = |a: f64, b: f64| match (a.is_nan(), b.is_nan()) {
        // Equal infinities are equal; NaN equals NaN and nothing else.
        _ if a == b => 0.0,
        (true, true) => 0.0,
        (true, false) | (false, true) => f64::INFINITY,
        (false, false) => (a - b).abs(),
    };
    Rgb::new(channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b))
}

struct Comparison {
    max: f64,
    at: (usize, usize),
    mean: f64,
    differing: usize,
    pixels: usize,
}

impl Comparison {
    fn new(picture: &Picture, differences: &[Rgb], tolerance: f64) -> Self {
        let largest = |d: &Rgb| d.r.max(d.g).max(d.b);
        let mut worst = (0.0, 0);
        for (i, d) in differences.iter().enumerate() {
            if largest(d) > worst.0 {
                worst = (largest(d), i);
            }
        }
        Self {
            max: worst.0,
            at: (worst.1 % picture.width, worst.1 / picture.width),
            mean: differences.iter().map(|d| d.mean()).sum::<f64>() / differences.len() as f64,
            differing: differences.iter().filter(|d| largest(d) > tolerance).count(),
            pixels: differences.len(),
        }
    }

    fn describe(&self, unit: &str, tolerance: f64) -> String {
        let Self { max, at: (x, y), mean, differing, pixels } = self;
        let where_ = if *max > 0.0 { format!(" at pixel {x},{y}") } else { String::new() };
        let by = if tolerance > 0.0 { format!(" by more than {tolerance}") } else { String::new() };
        format!("max {max}{unit}{where_}, mean {mean:.6}{unit}, {differing} of {pixels} pixels differ{by}\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_is_equal_to_itself_only() {
        let (nan, one) = (Rgb::gray(f64::NAN), Rgb::gray(1.0));
        assert_eq!(difference(nan, nan), Rgb::gray(0.0));
        assert_eq!(difference(nan, one), Rgb::gray(f64::INFINITY));
        assert_eq!(difference(Rgb::gray(f64::INFINITY), Rgb::gray(f64::INFINITY)), Rgb::gray(0.0));
    }
}
