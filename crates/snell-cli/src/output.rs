//! Where results go: never over what was read, never over what somebody may have worked on.

use crate::say::{self, FAILED, Failure, OrFail, Outcome, USAGE};
use snell_formats::{Report, disk, files};
use std::path::{Path, PathBuf};

/// The name of standard input and output.
pub const STANDARD: &str = "-";

/// Does the result go to standard output?
pub fn is_standard(output: &Path) -> bool {
    output.as_os_str() == STANDARD
}

/// What an output is called in messages.
pub fn shown(output: &Path) -> String {
    if is_standard(output) { "standard output".to_owned() } else { output.display().to_string() }
}

/// Refuses an output that is one of the files that were read, by whatever name.
pub fn refuse_inputs<'a>(output: &Path, inputs: impl IntoIterator<Item = &'a Path>) -> Outcome {
    if is_standard(output) {
        return Ok(());
    }
    match inputs.into_iter().find(|input| disk::is_same_file(output, input)) {
        None => Ok(()),
        Some(input) => {
            let also = if input == output { String::new() } else { format!(", as `{}`", input.display()) };
            let report =
                Report::error(format!("`{}` was read for this{also}: it is not written over", output.display()));
            Err(Failure::new(USAGE, report.help("name another file for the output")))
        }
    }
}

/// Refuses a file that is there, unless it may be written over.
pub fn refuse_existing(output: &Path, force: bool) -> Result<(), Report> {
    if output.exists() && !force && !is_device(output) {
        let report = Report::error(format!("`{}` exists", output.display()));
        return Err(report.help("choose another name with -o, or overwrite it with --force"));
    }
    Ok(())
}

/// Pipes and devices hold nothing that could be lost.
fn is_device(output: &Path) -> bool {
    output.metadata().is_ok_and(|m| !m.is_file() && !m.is_dir())
}

/// Writes a text to a file, or to standard output.
pub fn write_text(output: &Path, text: &str) -> Outcome {
    if is_standard(output) {
        return say::print(text);
    }
    disk::write(output, |out| out.write_all(text.as_bytes())).or_fail(FAILED)
}

/// Writes bytes that are made as they are written to a file, or to standard output.
pub fn write(output: &Path, content: impl FnOnce(&mut dyn files::Out) -> std::io::Result<()>) -> Outcome {
    if is_standard(output) {
        let bytes = files::in_memory(content);
        let bytes = bytes.map_err(|e| Report::error(format!("the result cannot be written: {e}"))).or_fail(FAILED)?;
        return say::print_bytes(&bytes);
    }
    disk::write(output, content).or_fail(FAILED)
}

/// A name beside a file, for what is not finished and must not take its place: `glass-unfinished.png`.
pub fn beside(output: &Path) -> PathBuf {
    let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, ending) = (part(output.file_stem()), part(output.extension()));
    let name = |number: u32| {
        let number = if number == 1 { String::new() } else { format!("-{number}") };
        output.with_file_name(format!("{stem}-unfinished{number}.{ending}"))
    };
    (1..=u32::MAX).map(name).find(|path| path.symlink_metadata().is_err()).unwrap_or_else(|| output.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_unfinished_takes_nobodys_place() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        assert_eq!(beside(&at("a.b.png")), at("a.b-unfinished.png"));
        std::fs::write(at("a.b-unfinished.png"), b"").unwrap();
        assert_eq!(beside(&at("a.b.png")), at("a.b-unfinished-2.png"));
    }

    #[test]
    fn inputs_are_refused_by_any_name() {
        let folder = tempfile::tempdir().unwrap();
        let (input, other) = (folder.path().join("in.toml"), folder.path().join("out.png"));
        std::fs::write(&input, b"x").unwrap();
        assert!(refuse_inputs(&other, [input.as_path()]).is_ok());
        std::fs::hard_link(&input, &other).unwrap();
        let failure = refuse_inputs(&other, [input.as_path()]).unwrap_err();
        assert!(failure.code == USAGE && failure.reports[0].message.contains("as `"), "{failure:?}");
        assert!(refuse_inputs(Path::new("-"), [Path::new("-")]).is_ok());
    }
}
