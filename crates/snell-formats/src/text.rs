//! Text as people have it: in UTF-8, with a byte order mark or without, or in UTF-16, as PowerShell's `>` writes it.

use crate::report::{Report, Source};
use snell::scene::WarningCode;

/// The text of some bytes, and W108 if some of them are no text.
///
/// A byte order mark decides, and is dropped; without one, a zero beside the first character tells UTF-16. Bytes that are no UTF-8
/// (an old Latin-1) become `\u{fffd}`, without a warning where they stand in comments only, behind `#`. The ends of lines are
/// [`Source::new`]'s affair.
pub fn decode(name: &str, bytes: &[u8]) -> (Source, Option<Report>) {
    let text = match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest),
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes).into(),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes).into(),
        [1..=127, 0, 1..=127, 0, ..] => utf16(bytes, u16::from_le_bytes).into(),
        [0, 1..=127, 0, 1..=127, ..] => utf16(bytes, u16::from_be_bytes).into(),
        _ => String::from_utf8_lossy(bytes),
    };
    let source = Source::new(name, &*text);
    let warning = first_lost(&source.text).map(|at| {
        let message = "bytes that are no UTF-8 text are read as U+FFFD";
        let help = "save the file as UTF-8";
        Report::warning(WarningCode::NotUtf8, message)
            .help(help)
            .at(&source, at..at + char::REPLACEMENT_CHARACTER.len_utf8())
    });
    (source, warning)
}

/// Half a character at the end is lost like any other that is none.
fn utf16(bytes: &[u8], unit: impl Fn([u8; 2]) -> u16) -> String {
    let (pairs, rest) = bytes.as_chunks::<2>();
    let text = char::decode_utf16(pairs.iter().map(|&pair| unit(pair)));
    let lost = (!rest.is_empty()).then_some(char::REPLACEMENT_CHARACTER);
    text.map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).chain(lost).collect()
}

/// The first character that could not be read and does not stand in a comment.
fn first_lost(text: &str) -> Option<usize> {
    text.match_indices(char::REPLACEMENT_CHARACTER).map(|(at, _)| at).find(|&at| {
        let start = text[..at].rfind('\n').map_or(0, |i| i + 1);
        !text[start..at].contains('#')
    })
}

/// Is it in UTF-16, by its byte order mark or by a zero beside each of its first characters?
pub(crate) fn is_utf16(bytes: &[u8]) -> bool {
    matches!(bytes, [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [1..=127, 0, 1..=127, 0, ..] | [0, 1..=127, 0, 1..=127, ..])
}

/// Does a file start like a text? Not with the zeros and control characters of binary formats.
pub fn looks_like_text(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(1024)];
    is_utf16(bytes) || !start.iter().any(|&b| b.is_ascii_control() && !b.is_ascii_whitespace() && b != 0x0b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn in_utf16(text: &str, unit: impl Fn(u16) -> [u8; 2]) -> Vec<u8> {
        text.encode_utf16().flat_map(unit).collect()
    }

    #[test]
    fn every_way_to_save_a_text_is_the_same_text() {
        let text = "solid a\nf 1 2 3 # größer 😀\n";
        let windows = text.replace('\n', "\r\n");
        for (what, bytes) in [
            ("as it is", text.as_bytes().to_vec()),
            ("with a mark", [&b"\xef\xbb\xbf"[..], text.as_bytes()].concat()),
            ("CR LF", windows.clone().into_bytes()),
            ("CR", text.replace('\n', "\r").into_bytes()),
            ("PowerShell", [&b"\xff\xfe"[..], &in_utf16(&windows, u16::to_le_bytes)].concat()),
            ("big-endian", [&b"\xfe\xff"[..], &in_utf16(&windows, u16::to_be_bytes)].concat()),
            ("without mark", in_utf16(text, u16::to_le_bytes)),
            ("big-endian without mark", in_utf16(text, u16::to_be_bytes)),
        ] {
            let (source, warning) = decode("m.obj", &bytes);
            assert!(*source.text == *text && warning.is_none(), "{what}: {:?}", source.text);
            assert!(looks_like_text(&bytes), "{what}");
        }
    }

    #[test]
    fn what_is_no_text_is_said_but_in_comments() {
        let warning = |bytes: &[u8]| decode("d.txt", bytes).1;
        assert!(warning(b"# gr\xf6\xdfer\neye 0 0 1 # \xe4\n").is_none());
        let found = warning(b"# \xf6\nload gr\xf6n.obj\n").unwrap();
        let (source, range) = found.place.unwrap();
        assert_eq!(source.line_column(range.start), (2, 8));
        assert!(warning(b"\xff\xfea\x00b").is_some(), "half a character");
        assert!(warning(b"\xff\xfe\x00\xd8a\x00").is_some(), "half a pair");
        for binary in [&b"\x89PNG\r\n\x1a\n\0"[..], b"glTF\x02\0\0\0", b"\x1f\x8b\x08\0", b"PK\x03\x04"] {
            assert!(!looks_like_text(binary));
        }
    }

    #[test]
    fn short_files_are_texts_too() {
        for length in 0..5 {
            for byte in [0, 1, b'a', 0xfe, 0xff] {
                let _ = (decode("x", &vec![byte; length]), looks_like_text(&vec![byte; length]));
            }
        }
    }
}
