//! Parts in files: what comes back, what joins, and what is refused.

use super::*;
use crate::files::disk;
use crate::load::{LoadOptions, load};
use crate::recipe::Changes;
use crate::report::Report;
use snell::render::{Grid, Options, PartialFilm, Rendered, render};
use snell::world::CompiledScene;
use std::path::Path;

struct Made {
    recipe: Recipe,
    compiled: CompiledScene,
}

impl Made {
    fn new(set: &[&str]) -> Self {
        let set = ["render.size=[48,36]", "render.spp=6"].iter().chain(set).map(ToString::to_string).collect();
        let options = LoadOptions { set, ..LoadOptions::default() };
        let loaded = load("gallery/bubbles", &options).unwrap();
        let mut recipe = Recipe::of(&loaded, &options, &Changes { set: options.set.clone(), ..Changes::default() });
        recipe.resolve(&loaded.scene);
        Self { recipe, compiled: CompiledScene::new("bubbles", loaded.scene).unwrap() }
    }

    fn whole(&self) -> Rendered {
        render(self.compiled.world(), &self.compiled.settings(), &Options::default()).unwrap()
    }

    fn part(&self, [x, y, width, height]: [u32; 4], samples: [u32; 2], path: &Path) {
        let crop = Crop { x, y, width, height };
        let mut film = PartialFilm::new([48, 36], crop, Grid::new(crop, 9, []));
        let [first, end] = samples;
        let (world, settings) = (self.compiled.world(), self.compiled.settings());
        film.render(world, &settings, first..end, &Options::default(), None).unwrap();
        let header = Header::new(&self.recipe, [48, 36], film.pieces(), film.statistics());
        disk::write(path, |out| write(out, &header, &film)).unwrap();
    }
}

fn merge(paths: &[&Path]) -> Result<Merge, Report> {
    Merge::new(paths.iter().map(|path| PartFile::open(path)).collect::<Result<_, _>>()?)
}

#[test]
fn parts_join_to_the_picture_and_as_trees() {
    let (made, folder) = (Made::new(&[]), tempfile::tempdir().unwrap());
    let at = |name: &str| folder.path().join(name);
    made.part([0, 0, 48, 20], [0, 4], &at("a.npz"));
    made.part([0, 0, 48, 20], [4, 6], &at("b.npz"));
    made.part([0, 20, 17, 16], [0, 6], &at("c.npz"));
    made.part([17, 20, 31, 16], [1, 6], &at("d.npz"));
    made.part([17, 20, 31, 16], [0, 1], &at("e.npz"));
    let whole = made.whole();
    let mut all = merge(&[&at("d.npz"), &at("a.npz"), &at("e.npz"), &at("c.npz"), &at("b.npz")]).unwrap();
    let (film, statistics) = all.film().unwrap();
    assert!(film.pixels == whole.film.pixels && film.is_finished());
    assert_eq!(statistics, whole.statistics);

    // Two into one, and that with the others; the joined parts are what all would have been at once.
    let join = |parts: &[&Path], to: &Path| {
        let mut some = merge(parts).unwrap();
        disk::write(to, |out| some.write(out)).unwrap();
    };
    join(&[&at("b.npz"), &at("d.npz")], &at("bd.npz"));
    join(&[&at("bd.npz"), &at("e.npz"), &at("c.npz")], &at("bcde.npz"));
    join(&[&at("a.npz"), &at("bcde.npz")], &at("all.npz"));
    let mut tree = merge(&[&at("all.npz")]).unwrap();
    assert_eq!(tree.header().pieces.len(), 1, "{:?}", tree.header().pieces);
    let (film, statistics) = tree.film().unwrap();
    assert!(film.pixels == whole.film.pixels);
    assert_eq!(statistics, whole.statistics);
}

#[test]
fn what_is_missing_or_double_is_named() {
    let (made, folder) = (Made::new(&[]), tempfile::tempdir().unwrap());
    let at = |name: &str| folder.path().join(name);
    made.part([0, 0, 48, 20], [0, 4], &at("a.npz"));
    made.part([0, 20, 48, 16], [0, 6], &at("b.npz"));
    made.part([0, 10, 48, 16], [3, 5], &at("c.npz"));
    let message = |paths: &[&Path]| match merge(paths).and_then(|mut all| all.film()) {
        Ok(_) => panic!("it is complete"),
        Err(report) => report.message.replace(&*folder.path().to_string_lossy(), ""),
    };
    assert_eq!(
        message(&[&at("a.npz"), &at("b.npz")]),
        "the picture is not complete; missing: rows 0 to 19, columns 0 to 47, samples 4 to 5"
    );
    assert_eq!(
        message(&[&at("b.npz")]),
        "the picture is not complete; missing: rows 0 to 19, columns 0 to 47, samples 0 to 5"
    );
    assert_eq!(
        message(&[&at("a.npz"), &at("b.npz"), &at("c.npz")]),
        "rows 10 to 19, columns 0 to 47, samples 3 are there twice: in `/a.npz` and in `/c.npz`"
    );
    assert!(
        message(&[&at("a.npz"), &at("a.npz")])
            .contains("rows 0 to 19, columns 0 to 47, samples 0 to 3 are there twice")
    );
    for (set, what) in [("material.water.eta=1.7", "`set`"), ("render.max_depth=3", "`depth` is")] {
        let other = Made::new(&[set]);
        other.part([0, 0, 48, 20], [4, 6], &at("other.npz"));
        let said = message(&[&at("a.npz"), &at("other.npz")]);
        assert!(
            said.starts_with("`/a.npz` and `/other.npz` are parts of different pictures: ") && said.contains(what),
            "{said}"
        );
    }
}

#[test]
fn what_is_cut_off_or_changed_is_refused() {
    let (made, folder) = (Made::new(&[]), tempfile::tempdir().unwrap());
    let path = folder.path().join("a.npz");
    made.part([0, 0, 48, 20], [0, 3], &path);
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!(PartFile::open(&path).unwrap().header().pieces.len(), 1);
    let refused = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        PartFile::open(&path).unwrap_err().message
    };
    for cut in [0, 1, 100, bytes.len() / 2, bytes.len() - 1] {
        assert!(refused(&bytes[..cut]).contains("no whole ZIP archive"), "cut at {cut}");
    }
    // One byte of the sums, of the lost light, of the header.
    let of = |name: &[u8]| bytes.windows(name.len()).position(|window| window == name).unwrap();
    for at in [of(b"sums.npy") + 500, of(b"lost.npy") + 200] {
        let mut changed = bytes.clone();
        changed[at] ^= 4;
        assert!(refused(&changed).to_lowercase().contains("checksum"), "{}", refused(&changed));
    }
    let mut changed = bytes.clone();
    let version = of(b"\"snell_part\":1") + b"\"snell_part\":".len();
    changed[version] = b'2';
    assert!(!refused(&changed).is_empty());
    std::fs::write(&path, b"no archive at all").unwrap();
    assert!(PartFile::open(&path).is_err() && PartFile::open(Path::new("nowhere.npz")).is_err());
}

/// A header promises more pixels than there are, and so does the directory of the archive, whose checksums are right.
#[test]
fn promises_take_no_memory() {
    let (made, folder) = (Made::new(&[]), tempfile::tempdir().unwrap());
    let path = folder.path().join("a.npz");
    let promised = |side: u32| {
        let rect = Crop { x: 0, y: 0, width: side, height: side };
        let mut header = Header::new(&made.recipe, [side; 2], vec![], Statistics::default());
        (header.crop, header.pieces) = (rect, vec![Piece { rect, samples: vec![[0, 1]] }]);
        disk::write(&path, |out| {
            let mut writer = write::Writer::new(out, &header)?;
            writer.begin_lost(&header)?;
            writer.finish(&header)
        })
        .unwrap();
    };
    let (rect, samples) = (Crop { x: 0, y: 0, width: 1_000_000_000, height: 1_000_000_000 }, vec![[0, 1]]);
    let said = check([1_000_000_000; 2], rect, 1, &[Piece { rect, samples }]).unwrap_err();
    assert_eq!(said, "more pixels than can be counted");
    promised(500_000_000);
    let said = PartFile::open(&path).unwrap_err().message;
    assert!(said.contains("`sums.npy` has 128 bytes, and 6000000000000000128 were expected"), "{said}");
    promised(10_000);
    let mut bytes = std::fs::read(&path).unwrap();
    for (name, size) in [(&b"sums.npy"[..], 128 + 24 * 100_000_000u32), (b"lost.npy", 128 + 8 * 100_000_000)] {
        let entry = bytes.windows(name.len()).rposition(|window| window == name).unwrap() - 46;
        bytes[entry + 24..entry + 28].copy_from_slice(&size.to_le_bytes());
    }
    std::fs::write(&path, bytes).unwrap();
    let said = PartFile::open(&path).unwrap_err().message;
    assert!(said.contains("`sums.npy` ends after 0 bytes of numbers, and 2400000000 were expected"), "{said}");
}

/// A change of a header, and why it is refused.
type Change<'a> = (&'a dyn Fn(&mut Header), &'a str);

#[test]
fn headers_that_cannot_be_are_refused() {
    let (made, folder) = (Made::new(&[]), tempfile::tempdir().unwrap());
    let path = folder.path().join("a.npz");
    let crop = Crop { x: 0, y: 0, width: 48, height: 2 };
    let mut film = PartialFilm::new([48, 36], crop, Grid::new(crop, 9, []));
    let (world, settings) = (made.compiled.world(), made.compiled.settings());
    film.render(world, &settings, 0..2, &Options::default(), None).unwrap();
    let good = Header::new(&made.recipe, [48, 36], film.pieces(), film.statistics());
    let refused = |change: &dyn Fn(&mut Header)| {
        // The arrays are those of the good one.
        let mut header = good.clone();
        change(&mut header);
        disk::write(&path, |out| {
            let mut writer = write::Writer::new(out, &good)?;
            for y in 0..2 {
                let mut sums = Vec::new();
                film.row(&good.pieces[0], y, &mut sums);
                writer.sums(&sums)?;
            }
            writer.begin_lost(&good)?;
            writer.lost(&[0; 96])?;
            writer.finish(&header)
        })
        .unwrap();
        PartFile::open(&path).map(drop).map_err(|report| report.message)
    };
    assert!(refused(&|_| {}).is_ok());
    let changes: [Change<'_>; 10] = [
        (&|h| h.snell_part = 2, "of version 2, and this Snell reads 1"),
        (&|h| h.size = [40, 36], "does not lie within"),
        (&|h| h.spp = 0, "samples per pixel"),
        (&|h| h.pieces[0].rect.height = 3, "bytes, and"),
        (&|h| h.pieces[0].rect.x = u32::MAX, "does not lie within"),
        (&|h| h.pieces[0].samples = vec![[0, 3]], "bytes, and"),
        (&|h| h.pieces[0].samples = vec![[1, 2], [0, 1]], "no ranges of 6 samples"),
        (&|h| h.pieces[0].samples = vec![[2, 2]], "no ranges of 6 samples"),
        (&|h| h.pieces[0].samples = vec![[0, 7]], "no ranges of 6 samples"),
        (&|h| h.pieces[0].samples = vec![], "without samples"),
    ];
    for (change, why) in changes {
        let said = refused(change).unwrap_err();
        assert!(said.contains(why), "{why}: {said}");
    }
}
