//! `snell scenes`.

use crate::args::ScenesArgs;
use crate::excerpt::plain;
use crate::output::{is_standard, refuse_existing, write_text};
use crate::say::{self, FAILED, OrFail, Outcome, USAGE};
use snell_formats::{builtin, disk};
use std::fmt::Write;
use std::path::PathBuf;

pub fn run(args: &ScenesArgs) -> Outcome {
    if let Some(name) = &args.save {
        let source = builtin::find(name).or_fail(USAGE)?;
        let file = name.rsplit('/').next().unwrap_or(name);
        let output = args.output.clone().unwrap_or_else(|| PathBuf::from(format!("{file}.toml")));
        if !is_standard(&output) {
            refuse_existing(&output, args.force).or_fail(FAILED)?;
            disk::check_writable(&output).or_fail(FAILED)?;
        }
        write_text(&output, &source.text)?;
        if is_standard(&output) { Ok(()) } else { say::print(&plain(&format!("{}\n", output.display()))) }
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
