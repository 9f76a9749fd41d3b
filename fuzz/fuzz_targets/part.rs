//! Parts of pictures. The adversary is a header that promises 1e18 pixels, in an archive that promises their bytes and has none.
#![no_main]

use libfuzzer_sys::fuzz_target;
use snell_formats::part::PartFile;
use std::sync::LazyLock;

static FOLDER: LazyLock<tempfile::TempDir> = LazyLock::new(|| tempfile::tempdir().unwrap());

fuzz_target!(|data: &[u8]| {
    let path = FOLDER.path().join("part.npz");
    std::fs::write(&path, data).unwrap();
    let Ok(mut part) = PartFile::open(&path) else { return };
    let share = part.header().share();
    assert!(share.is_finite() && share > 0.0 || part.header().pieces.is_empty());
    for number in 0..part.header().pieces.len() {
        let piece = part.header().pieces[number].clone();
        let rows = piece.rect.y..piece.rect.y + piece.rect.height;
        // What opens is whole, so that its numbers take no more memory than the file does.
        let (sums, lost) = (part.sums(number, &rows).unwrap(), part.lost(number, &rows).unwrap());
        assert_eq!(lost.len() as u64, piece.pixel_count());
        assert_eq!(sums.len(), lost.len() * piece.blocks().len());
    }
});
