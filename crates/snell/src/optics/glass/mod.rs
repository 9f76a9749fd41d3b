//! The catalogue of glasses and other clear materials, by name.

mod catalogue;

pub use catalogue::CATALOGUE;

use super::dispersion::Dispersion;

/// A material whose refractive index has been measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Glass {
    /// As makers and books write it.
    pub name: &'static str,
    /// Other names for the same.
    pub aliases: &'static [&'static str],
    /// Index by wavelength: relative to air for glasses, to a vacuum for water and air, else as the source has it.
    pub dispersion: Dispersion,
    /// At which temperature it was measured, in °C, where that is known.
    pub temperature_c: Option<f64>,
    /// Who measured it, and where that was published.
    pub source: &'static str,
    /// Where refractiveindex.info's database has it: the path of a `.yml` file in its folder `data`.
    pub page: &'static str,
}

/// No material is called like this.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("no glass is called `{name}`; {}", nearest_of(.nearest))]
pub struct UnknownGlass {
    /// What was asked for.
    pub name: String,
    /// The most similar names, best first; none if none is similar.
    pub nearest: Vec<&'static str>,
}

/// The material of this name or alias; capital letters, spaces, dashes and underscores do not matter.
///
/// # Errors
/// An unknown name, with those that are most like it.
pub fn find(name: &str) -> Result<&'static Glass, UnknownGlass> {
    let wanted = plain(name);
    CATALOGUE
        .iter()
        .find(|glass| names(glass).any(|known| plain(known) == wanted))
        .ok_or_else(|| UnknownGlass { name: name.to_owned(), nearest: nearest(&wanted) })
}

fn names(glass: &Glass) -> impl Iterator<Item = &'static str> {
    std::iter::once(glass.name).chain(glass.aliases.iter().copied())
}

/// What of a name matters.
fn plain(name: &str) -> String {
    name.chars().filter(|c| !matches!(c, ' ' | '-' | '_')).flat_map(char::to_lowercase).collect()
}

/// The names that are most like a plain one, at most three, at most one of each material.
fn nearest(wanted: &str) -> Vec<&'static str> {
    let similarity = |known: &str| strsim::normalized_damerau_levenshtein(wanted, &plain(known));
    let mut candidates: Vec<(f64, &str)> = CATALOGUE
        .iter()
        .filter_map(|glass| names(glass).map(|known| (similarity(known), known)).max_by(|a, b| a.0.total_cmp(&b.0)))
        // Half of the letters: BK9 finds BK7.
        .filter(|(similarity, _)| *similarity >= 0.5)
        .collect();
    // Stable: equals stay in the order of the catalogue.
    candidates.sort_by(|a, b| b.0.total_cmp(&a.0));
    candidates.into_iter().map(|(_, known)| known).take(3).collect()
}

/// The second half of the message.
fn nearest_of(nearest: &[&str]) -> String {
    match nearest {
        [] => format!("known are {}", CATALOGUE.iter().map(|glass| glass.name).collect::<Vec<_>>().join(", ")),
        [one] => format!("did you mean {one}?"),
        [others @ .., last] => format!("did you mean {} or {last}?", others.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::dispersion::{Formula, LINE_C_NM, LINE_D_NM, LINE_F_NM, VISIBLE_NM};
    use snell_test_scenes::real_files::data;

    fn lines(name: &str) -> [f64; 3] {
        [LINE_F_NM, LINE_D_NM, LINE_C_NM].map(|line| find(name).unwrap().dispersion.eta(line).unwrap())
    }

    /// Figures that others computed from the same data, to six digits and two.
    #[test]
    fn indices_and_abbe_numbers_are_the_known_ones() {
        for (name, etas, abbe_number) in [
            ("N-BK7", [1.522_376, 1.516_800, 1.514_322], 64.17),
            ("N-SF11", [1.806_513, 1.784_720, 1.775_955], 25.68),
            ("fused silica", [1.463_126, 1.458_464, 1.456_367], 67.82),
            ("diamond", [2.435_538, 2.417_486, 2.409_906], 55.30),
            ("water", [1.337_492, 1.333_403, 1.331_513], 55.76),
            ("sapphire", [1.775_508, 1.768_172, 1.764_884], 72.31),
        ] {
            for (found, known) in lines(name).into_iter().zip(etas) {
                // Half a unit of the last digit, and the rounding of writing it down.
                assert!((found - known).abs() < 0.51e-6, "{name}: {found} for {known}");
            }
            let found = find(name).unwrap().dispersion.abbe_number().unwrap();
            assert!((found - abbe_number).abs() < 0.0051, "{name}: {found} for {abbe_number}");
        }
        // Air by the equation of Birch and Downs, Metrologia 31, 315 (1994), of the same state; both claim some 1e-8.
        let air = find("air").unwrap().dispersion.eta(630.0).unwrap();
        assert!((air - 1.000_276_567).abs() < 2e-8, "{air}");
        // Germanium by Li's table of 1993, from other samples: measurements of it differ by 2e-3.
        let germanium = find("Ge").unwrap().dispersion.eta(10_000.0).unwrap();
        assert!((germanium - 4.0025).abs() < 2e-3, "{germanium}");
    }

    #[test]
    fn names_are_found_as_people_write_them() {
        for (written, name) in [
            ("N-BK7", "N-BK7"),
            ("bk7", "N-BK7"),
            ("n bk 7", "N-BK7"),
            ("NSF11", "N-SF11"),
            ("sf-11", "SF11"),
            ("Fused Silica", "fused silica"),
            ("fused_silica", "fused silica"),
            ("caf2", "calcium fluoride"),
            ("WATER", "water"),
        ] {
            assert_eq!(find(written).unwrap().name, name, "{written}");
        }
        let mut all: Vec<String> = CATALOGUE.iter().flat_map(names).map(plain).collect();
        all.sort();
        let count = all.len();
        all.dedup();
        assert_eq!(all.len(), count, "no name stands for two");
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_nearest() {
        let message = |name| find(name).unwrap_err().to_string();
        assert_eq!(message("N-SF12"), "no glass is called `N-SF12`; did you mean N-SF10, N-SF11 or N-SF6?");
        assert_eq!(message("diamant"), "no glass is called `diamant`; did you mean diamond?");
        assert!(find("saphire").unwrap_err().nearest.starts_with(&["sapphire"]));
        let everything = message("unobtainium");
        assert!(everything.contains("known are N-BK7, ") && everything.ends_with(", air"), "{everything}");
    }

    #[test]
    fn every_entry_is_sound_over_its_whole_range() {
        for Glass { name, dispersion, source, .. } in CATALOGUE {
            assert!(!source.is_empty());
            let [shortest, longest] = dispersion.range_nm;
            let steps = 2000;
            let mut last = f64::INFINITY;
            for i in 0..=steps {
                let wavelength_nm = shortest + (longest - shortest) * f64::from(i) / f64::from(steps);
                let eta = dispersion.eta(wavelength_nm.min(longest)).unwrap();
                // At both ends of the range, where absorption begins, water and fused silica come near to 1.
                assert!(1.0 < eta && eta < 4.2, "{name}: {eta} at {wavelength_nm} nm");
                let visible = (VISIBLE_NM[0]..=VISIBLE_NM[1]).contains(&wavelength_nm);
                assert!(!visible || eta < last, "{name}: blue is bent more, {wavelength_nm} nm");
                last = eta;
            }
            for outside in [shortest * (1.0 - 1e-9), longest * (1.0 + 1e-9)] {
                assert!(dispersion.eta(outside).is_err());
            }
        }
    }

    #[test]
    fn every_entry_is_documented() {
        let docs = include_str!("../../../../../docs/glasses.md");
        for Glass { name, aliases, dispersion, .. } in CATALOGUE {
            let number =
                |value: Result<f64, _>, digits: usize| value.map_or("-".to_owned(), |v| format!("{v:.digits$}"));
            let (eta, abbe_number) = (number(dispersion.eta(LINE_D_NM), 5), number(dispersion.abbe_number(), 2));
            let [shortest, longest] = dispersion.range_nm;
            let row = format!("| {name} | {} | {eta} | {abbe_number} | {shortest} to {longest} |", aliases.join(", "));
            assert!(docs.contains(&row), "docs/glasses.md lacks\n{row}");
        }
    }

    /// The numbers behind a key of a `.yml` file, which is enough of that format here.
    fn numbers(yml: &str, key: &str) -> Option<Vec<f64>> {
        let line = yml.lines().find_map(|line| line.trim_start().strip_prefix(key)?.strip_prefix(':'))?;
        line.split_whitespace().map(|word| word.parse().ok()).collect()
    }

    #[test]
    fn every_entry_has_the_numbers_of_its_file() {
        let Some(folder) = data().map(|data| data.join("glass")) else { return };
        for glass in CATALOGUE {
            let file = folder.join(format!("{}.yml", glass.page.replace('/', "_")));
            let yml = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            let (kind, first, terms) = match &glass.dispersion.formula {
                Formula::Sellmeier(first, terms) => ("formula 1", first, terms),
                Formula::SellmeierSquared(first, terms) => ("formula 2", first, terms),
                Formula::Gas(first, terms) => ("formula 6", first, terms),
                other => panic!("no file has {other:?}"),
            };
            assert!(yml.contains(&format!("type: {kind}\n")), "{}: {kind}", glass.name);
            let ours: Vec<f64> = std::iter::once(*first).chain(terms.iter().flatten().copied()).collect();
            assert_eq!(numbers(&yml, "coefficients"), Some(ours), "{}", glass.name);
            let range = numbers(&yml, "wavelength_range").unwrap();
            for (ours, theirs) in glass.dispersion.range_nm.into_iter().zip(range) {
                // µm to nm rounds.
                assert!((ours - theirs * 1000.0).abs() < 1e-9, "{}: {ours}", glass.name);
            }
            if let (Some(ours), Some(kelvin)) = (glass.temperature_c, numbers(&yml, "temperature")) {
                // Some files give whole kelvins.
                assert!((ours + 273.15 - kelvin[0]).abs() < 0.2, "{}: {ours} °C", glass.name);
            }
            if let (Some(nd), Some(vd)) = (numbers(&yml, "nd"), numbers(&yml, "Vd")) {
                // As the maker prints them, five digits and two; its Abbe numbers come from more digits than its formula.
                assert!((lines(glass.name)[1] - nd[0]).abs() < 0.6e-5, "{}: {nd:?}", glass.name);
                assert!((glass.dispersion.abbe_number().unwrap() - vd[0]).abs() < 0.01, "{}: {vd:?}", glass.name);
            }
        }
    }
}
