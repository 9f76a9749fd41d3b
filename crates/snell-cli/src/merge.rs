//! `snell merge`.

use crate::args::MergeArgs;
use crate::output::{self, is_standard, refuse_inputs};
use crate::recipe::short_hash;
use crate::say::{FAILED, Failure, OrFail, Outcome, SCENE, USAGE, tell};
use snell::film::BYTES_PER_PIXEL;
use snell::film::transfer::Encoding;
use snell_formats::part::{Merge, PartFile};
use snell_formats::picture::{Format, Writing};
use snell_formats::{disk, memory};

pub fn run(args: &MergeArgs) -> Outcome {
    refuse_inputs(&args.output, args.parts.iter().map(AsRef::as_ref))?;
    if !is_standard(&args.output) {
        disk::check_writable(&args.output).or_fail(FAILED)?;
    }
    let is_part = args.output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npz"));
    let format = if is_part { None } else { Some(Format::of(&args.output).or_fail(USAGE)?) };
    let parts: Vec<PartFile> =
        args.parts.iter().map(|path| PartFile::open(path)).collect::<Result<_, _>>().or_fail(FAILED)?;
    let count = parts.len();
    let mut merge = Merge::new(parts).or_fail(FAILED)?;
    let Some(format) = format else {
        output::write(&args.output, |out| merge.write(out))?;
        say(args, &format!("{}: {count} parts in one", args.output.display()));
        return Ok(());
    };
    merge.check_complete().or_fail(FAILED)?;
    enough_memory(&merge)?;
    let (film, statistics) = merge.film().or_fail(FAILED)?;
    let mut recipe = merge.header().recipe.clone();
    recipe.remember(&film);
    let format = match format {
        Format::Png { .. } => Format::Png { sixteen_bit: recipe.bits == Some(16) },
        other => other,
    };
    let encoding =
        Encoding { transfer: recipe.transfer.unwrap_or_default(), rounding: recipe.rounding.unwrap_or_default() };
    let (text, writing) = (recipe.to_json(), Writing { format, encoding, threads: 0 });
    output::write(&args.output, |out| writing.write_to(out, &film, || Some(text)))?;
    let (lost, hash) = (statistics.lost, recipe.film_sha256.as_deref().unwrap_or_default());
    let [x, y] = [lost.worst_pixel(film.full_size[0]).0, lost.worst_pixel(film.full_size[0]).1];
    say(
        args,
        &format!(
            "{}: {} x {} from {}, {} rays, film {}",
            args.output.display(),
            film.crop.width,
            film.crop.height,
            if count == 1 { "one part".to_owned() } else { format!("{count} parts") },
            statistics.rays.total(),
            short_hash(hash)
        ),
    );
    if lost.rays > 0 {
        let (share, worst) = (100.0 * lost.share(statistics.rays.camera), 100.0 * lost.worst(merge.header().spp));
        say(
            args,
            &format!(
                "  {} branches were cut off: {share:.2} % of a pixel on average, {worst:.1} % in pixel {x},{y}",
                lost.rays
            ),
        );
    }
    Ok(())
}

fn say(args: &MergeArgs, text: &str) {
    if !args.quiet {
        tell(text);
    }
}

fn enough_memory(merge: &Merge) -> Outcome {
    let crop = merge.header().crop;
    let needed = u64::from(crop.width).saturating_mul(u64::from(crop.height)).saturating_mul(BYTES_PER_PIXEL);
    let what = format!("a picture of {} x {} pixels", crop.width, crop.height);
    memory::check(&what, needed).map_err(|report| Failure::new(SCENE, report)).map(drop)
}
