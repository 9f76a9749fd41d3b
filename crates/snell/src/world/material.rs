//! From the materials of a scene to those of the kernels.

use crate::optics::dispersion::LINE_D_NM;
use crate::optics::spectrum::Band;
use crate::scene::{Material, Scene};
use crate::stage::{CompiledMaterial, NONE};

/// All materials of a scene, in its order, and the indices of the bands, of each that is dispersive. `has_alpha` says which
/// patterns have places where the surface is not there.
pub(super) fn compile(scene: &Scene, bands: &[Band], has_alpha: &[bool]) -> (Vec<CompiledMaterial>, Vec<Vec<f64>>) {
    let mut spectra: Vec<Vec<f64>> = Vec::new();
    let mut compiled = |material: &Material| {
        let dispersion = material.dispersion().ok();
        // Validation has seen to it that there are indices.
        let eta_at = |nm: f64| dispersion.as_ref().and_then(|dispersion| dispersion.eta(nm).ok());
        let eta = eta_at(LINE_D_NM).unwrap_or(material.eta);
        let indices: Vec<f64> = bands.iter().filter_map(|band| eta_at(band.wavelength_nm)).collect();
        let differ = indices.iter().any(|index| index.to_bits() != eta.to_bits());
        let spectrum = if differ && indices.len() == bands.len() {
            let known = spectra.iter().position(|other| *other == indices);
            known.unwrap_or_else(|| {
                spectra.push(indices);
                spectra.len() - 1
            }) as u32
        } else {
            NONE
        };
        let pattern = material.texture.as_ref().and_then(|name| scene.textures.get_index_of(name));
        let has_holes = pattern.is_some_and(|pattern| has_alpha[pattern]);
        // What lets no light through is no pane.
        let lets_through = material.is_transparent() || has_holes;
        CompiledMaterial {
            ka: material.ka,
            kd: material.kd,
            ks: material.ks,
            kr: material.kr,
            ko: material.ko,
            spow: material.spow,
            emission: material.emission,
            eta,
            sigma_a: material.absorption(),
            thickness: material.thickness.filter(|_| lets_through).unwrap_or(-1.0),
            priority: material.priority,
            tints: if material.tinted_transmission { 1.0 } else { 0.0 },
            spectrum,
            pattern: pattern.map_or(NONE, |pattern| pattern as u32),
            has_holes,
        }
    };
    let mut materials: Vec<CompiledMaterial> = scene.materials.values().map(&mut compiled).collect();
    if materials.is_empty() {
        // Where nothing is, nobody asks what it is made of; but rows of the background are rows like others.
        materials.push(compiled(&Material::default()));
    }
    (materials, spectra)
}
