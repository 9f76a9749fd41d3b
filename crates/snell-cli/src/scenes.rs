//! `snell scenes`.

use crate::args::ScenesArgs;
use crate::say::{self, FAILED, OrFail, Outcome, USAGE};
use snell_formats::{Report, builtin, disk};
use std::fmt::Write;
use std::path::{Path, PathBuf};

pub fn run(args: &ScenesArgs) -> Outcome {
    if let Some(name) = &args.save {
        let source = builtin::find(name).or_fail(USAGE)?;
        let file = name.rsplit('/').next().unwrap_or(name);
        let output = args.output.clone().unwrap_or_else(|| PathBuf::from(format!("{file}.toml")));
        save(&output, &source.text, args.force)?;
        say::print(&format!("{}\n", output.display()))
    } else {
        let mut list = String::new();
        for (name, text) in builtin::SCENES {
            let first = builtin::description(text).first().copied().unwrap_or_default();
            let _ = writeln!(list, "{name:26}{first}");
        }
        list.push_str("\nsnell render NAME draws one, snell scenes --save NAME writes it to a file to change.\n");
        say::print(&list)
    }
}

/// Writes a text file that somebody may have worked on: not over an existing one unless asked.
pub fn save(output: &Path, text: &str, force: bool) -> Outcome {
    if output.exists() && !force {
        let report = Report::error(format!("`{}` exists", output.display()));
        return Err(say::Failure::new(
            FAILED,
            report.help("choose another name with -o, or overwrite it with --force"),
        ));
    }
    disk::write(output, |out| out.write_all(text.as_bytes())).or_fail(FAILED)
}
