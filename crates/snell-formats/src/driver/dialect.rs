//! Which year a driver is from.

use crate::report::{Remedy, Report};
use crate::words::{Line, number};
use snell::scene::{Integrator, Rounding, WarningCode};

/// The years of the course, by what their drivers mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// 2017 and 2018, assignments 3 and 4.
    Course2018,
    /// 2017 and 2018, last assignment: the lecture.
    Lecture,
    /// 2019.
    Course2019,
    /// 2020.
    Course2020,
}

impl Dialect {
    /// All of them; of equally likely ones the first is taken.
    pub const ALL: [Self; 4] = [Self::Course2018, Self::Lecture, Self::Course2019, Self::Course2020];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Course2018 => "2018",
            Self::Lecture => "lecture",
            Self::Course2019 => "2019",
            Self::Course2020 => "2020",
        }
    }

    /// The way of blending.
    pub fn integrator(self) -> Integrator {
        match self {
            Self::Course2018 => Integrator::Course2018,
            Self::Lecture => Integrator::Lecture,
            Self::Course2019 | Self::Course2020 => Integrator::Course2020,
        }
    }

    /// What happens to the fraction in 8 bit.
    pub fn rounding(self) -> Rounding {
        if self == Self::Course2018 { Rounding::Truncate } else { Rounding::Round }
    }

    /// Exponent of the highlight where the driver or the material gives none.
    pub fn default_exponent(self) -> f64 {
        if self == Self::Course2018 { 19.0 } else { 16.0 }
    }

    /// 2017 and 2018: `d` is positive and `bounds` are left, bottom, right, top.
    pub fn is_early(self) -> bool {
        matches!(self, Self::Course2018 | Self::Lecture)
    }
}

/// What a line says about the year, and how much that weighs.
struct Evidence<'a> {
    line: &'a Line<'a>,
    fits: &'static [Dialect],
    weight: u32,
}

use Dialect::{Course2018, Course2019, Course2020, Lecture};

/// The forms of a line that belong to some years only decide; habits of spelling only tip the balance.
const DECIDES: u32 = 100;
const HINTS: u32 = 1;

fn evidence<'a>(line: &'a Line<'a>) -> Option<Evidence<'a>> {
    let values: Vec<f64> = line.rest.iter().map_while(number).collect();
    let numbers = values.len();
    let found = |fits, weight| Some(Evidence { line, fits, weight });
    match line.keyword.text {
        "camera" | "trans" | "load" | "cutoffAngle" => found(&[Course2020], DECIDES),
        "eye" | "look" | "up" => found(&[Course2018, Lecture, Course2019], DECIDES),
        "d" => match values.first() {
            Some(d) if *d > 0.0 => found(&[Course2018, Lecture], DECIDES),
            Some(d) if *d < 0.0 => found(&[Course2019], DECIDES),
            _ => None,
        },
        "model" if numbers >= 9 => found(&[Course2019], DECIDES),
        "model" => found(&[Course2018, Lecture], DECIDES),
        "sphere" => match numbers {
            13 => found(&[Course2018, Lecture], HINTS),
            17 => found(&[Course2019, Course2020], DECIDES),
            20 | 21 => found(&[Lecture], DECIDES),
            // One number short or too many: an error in any year, to be told in the words of the likeliest.
            18 | 19 | 22 => found(&[Lecture], HINTS),
            _ => None,
        },
        "bounds" if numbers == 4 => {
            // One of the two orders has no area, or runs backwards.
            let early = (values[2] - values[0], values[3] - values[1]);
            let late = (values[1] - values[0], values[3] - values[2]);
            let area = |(w, h): (f64, f64)| w != 0.0 && h != 0.0;
            let forward = |(w, h): (f64, f64)| w > 0.0 && h > 0.0;
            match (area(early), area(late), forward(early), forward(late)) {
                (true, false, ..) => found(&[Course2018, Lecture], DECIDES),
                (false, true, ..) => found(&[Course2019, Course2020], DECIDES),
                (_, _, true, false) => found(&[Course2018, Lecture], HINTS),
                (_, _, false, true) => found(&[Course2019, Course2020], HINTS),
                _ => None,
            }
        }
        "recursionLevel" => found(&[Course2018, Lecture], HINTS),
        "recursionlevel" => found(&[Course2019, Course2020], HINTS),
        "eta_outside" => found(&[Lecture], HINTS),
        _ => None,
    }
}

/// The year that most lines speak for, and a warning about the lines that speak against it.
pub(super) fn recognise(lines: &[Line<'_>]) -> (Dialect, Vec<Report>) {
    let evidence: Vec<Evidence<'_>> = lines.iter().filter_map(evidence).collect();
    let score =
        |dialect: Dialect| -> u32 { evidence.iter().filter(|e| e.fits.contains(&dialect)).map(|e| e.weight).sum() };
    let mut best = Dialect::ALL[0];
    for dialect in Dialect::ALL {
        if score(dialect) > score(best) {
            best = dialect;
        }
    }
    let against = evidence.iter().filter(|e| e.weight == DECIDES && !e.fits.contains(&best));
    let warnings = against
        .map(|e| {
            let others: Vec<&str> = e.fits.iter().map(|d| d.name()).collect();
            let message = format!(
                "read as a driver of the dialect {}, but this line looks like {}",
                best.name(),
                others.join(" or ")
            );
            Report::warning(WarningCode::UnclearDialect, message)
                .at(e.line.source, e.line.range())
                .remedy(Remedy::NameDialect)
        })
        .collect();
    (best, warnings)
}
