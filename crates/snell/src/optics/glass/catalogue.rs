//! The numbers of the catalogue, each line as refractiveindex.info's database (CC0) has it.
//!
//! What is called like the older glass of another composition (LASF9, BAK1) has no alias: it would be a wrong answer that
//! nobody notices. N-BK7 was made to have BK7's index.

use super::Glass;
use crate::optics::dispersion::{Dispersion, Formula};
use std::borrow::Cow;

const SCHOTT: &str = "SCHOTT Zemax catalog 2017-01-20b";

/// Glasses first, then crystals, liquids and gases.
pub static CATALOGUE: &[Glass] = &[
    Glass {
        name: "N-BK7",
        aliases: &["BK7"],
        dispersion: sellmeier_squared(
            [300.0, 2500.0],
            &[[1.039_612_12, 0.006_000_698_67], [0.231_792_344, 0.020_017_914_4], [1.010_469_45, 103.560_653]],
        ),
        temperature_c: Some(20.0),
        source: SCHOTT,
        page: "specs/schott/optical/N-BK7",
    },
    Glass {
        name: "N-BAK1",
        aliases: &[],
        dispersion: sellmeier_squared(
            [300.0, 2500.0],
            &[[1.123_656_62, 0.006_447_427_52], [0.309_276_848, 0.022_228_440_2], [0.881_511_957, 107.297_751]],
        ),
        temperature_c: Some(20.0),
        source: SCHOTT,
        page: "specs/schott/optical/N-BAK1",
    },
    Glass {
        name: "N-FK51A",
        aliases: &[],
        dispersion: sellmeier_squared(
            [290.0, 2500.0],
            &[[0.971_247_817, 0.004_723_019_95], [0.216_901_417, 0.015_357_561_2], [0.904_651_666, 168.68133]],
        ),
        temperature_c: Some(20.0),
        source: SCHOTT,
        page: "specs/schott/optical/N-FK51A",
    },
    Glass {
        name: "N-LASF9",
        aliases: &[],
        dispersion: sellmeier_squared(
            [365.0, 2500.0],
            &[[2.000_295_47, 0.012_142_601_7], [0.298_926_886, 0.053_873_623_6], [1.806_918_43, 156.530_829]],
        ),
        temperature_c: Some(20.0),
        source: SCHOTT,
        page: "specs/schott/optical/N-LASF9",
    },
    Glass {
        name: "N-SF6",
        aliases: &[],
        dispersion: sellmeier_squared(
            [370.0, 2500.0],
            &[[1.779_317_63, 0.013_371_418_2], [0.338_149_866, 0.061_753_362_1], [2.087_344_74, 174.01759]],
        ),
        temperature_c: Some(20.0),
        source: SCHOTT,
        page: "specs/schott/optical/N-SF6",
    },
    Glass {
        name: "N-SF10",
        aliases: &[],
        dispersion: sellmeier_squared(
            [380.0, 2500.0],
            &[[1.621_539_02, 0.012_224_145_7], [0.256_287_842, 0.059_573_677_5], [1.644_475_52, 147.468_793]],
        ),
        temperature_c: Some(20.0),
        source: SCHOTT,
        page: "specs/schott/optical/N-SF10",
    },
    Glass {
        name: "N-SF11",
        aliases: &[],
        dispersion: sellmeier_squared(
            [370.0, 2500.0],
            &[[1.737_596_95, 0.013_188_707], [0.313_747_346, 0.062_306_814_2], [1.898_781_01, 155.23629]],
        ),
        temperature_c: Some(20.0),
        source: SCHOTT,
        page: "specs/schott/optical/N-SF11",
    },
    Glass {
        name: "F2",
        aliases: &[],
        dispersion: sellmeier_squared(
            [320.0, 2500.0],
            &[[1.345_333_59, 0.009_977_438_71], [0.209_073_176, 0.047_045_076_7], [0.937_357_162, 111.886_764]],
        ),
        temperature_c: Some(20.0),
        source: SCHOTT,
        page: "specs/schott/optical/F2",
    },
    Glass {
        name: "SF6",
        aliases: &[],
        dispersion: sellmeier_squared(
            [365.0, 2500.0],
            &[[1.724_484_82, 0.013_487_194_7], [0.390_104_889, 0.056_931_809_5], [1.045_728_58, 118.557_185]],
        ),
        temperature_c: Some(20.0),
        source: SCHOTT,
        page: "specs/schott/optical/SF6",
    },
    Glass {
        name: "SF10",
        aliases: &[],
        dispersion: sellmeier_squared(
            [380.0, 2500.0],
            &[[1.616_259_77, 0.012_753_455_9], [0.259_229_334, 0.058_198_395_4], [1.077_623_17, 116.60768]],
        ),
        temperature_c: Some(20.0),
        source: SCHOTT,
        page: "specs/schott/optical/SF10",
    },
    Glass {
        name: "SF11",
        aliases: &[],
        dispersion: sellmeier_squared(
            [390.0, 2500.0],
            &[[1.738_484_03, 0.013_606_860_4], [0.311_168_974, 0.061_596_046_3], [1.174_908_71, 121.922_711]],
        ),
        temperature_c: Some(20.0),
        source: SCHOTT,
        page: "specs/schott/optical/SF11",
    },
    Glass {
        name: "fused silica",
        aliases: &["silica", "SiO2", "quartz glass"],
        dispersion: sellmeier(
            [210.0, 6700.0],
            &[[0.696_166_3, 0.068_404_3], [0.407_942_6, 0.116_241_4], [0.897_479_4, 9.896_161]],
        ),
        temperature_c: Some(20.0),
        source: "Malitson, Interspecimen comparison of the refractive index of fused silica, J. Opt. Soc. Am. 55, 1205 (1965); range: Tan, J. Non-Cryst. Solids 223, 158 (1998)",
        page: "main/SiO2/nk/Malitson",
    },
    Glass {
        name: "water",
        aliases: &["H2O"],
        dispersion: sellmeier_squared(
            [182.0, 1129.0],
            &[
                [5.684_027_565e-1, 5.101_829_712e-3],
                [1.726_177_391e-1, 1.821_153_936e-2],
                [2.086_189_578e-2, 2.620_722_293e-2],
                [1.130_748_688e-1, 1.069_792_721e1],
            ],
        ),
        temperature_c: Some(20.0),
        source: "Daimon and Masumura, Measurement of the refractive index of distilled water from the near-infrared region to the ultraviolet region, Appl. Opt. 46, 3811 (2007)",
        page: "main/H2O/nk/Daimon-20.0C",
    },
    Glass {
        name: "sapphire",
        aliases: &["sapphire (o)", "sapphire (ordinary)", "Al2O3"],
        dispersion: sellmeier(
            [200.0, 5000.0],
            &[[1.431_349_3, 0.072_663_1], [0.650_547_13, 0.119_324_2], [5.341_402_1, 18.028_251]],
        ),
        temperature_c: Some(20.0),
        source: "ordinary ray; Malitson and Dodge, Refractive index and birefringence of synthetic sapphire, J. Opt. Soc. Am. 62, 1405 (1972)",
        page: "main/Al2O3/nk/Malitson-o",
    },
    Glass {
        name: "sapphire (e)",
        aliases: &["sapphire (extraordinary)"],
        dispersion: sellmeier(
            [200.0, 5000.0],
            &[[1.503_975_9, 0.074_028_8], [0.550_691_41, 0.121_652_9], [6.592_737_9, 20.072_248]],
        ),
        temperature_c: Some(20.0),
        source: "extraordinary ray; Malitson and Dodge, Refractive index and birefringence of synthetic sapphire, J. Opt. Soc. Am. 62, 1405 (1972)",
        page: "main/Al2O3/nk/Malitson-e",
    },
    Glass {
        name: "diamond",
        aliases: &[],
        dispersion: sellmeier([226.0, 760.0], &[[0.3306, 0.175], [4.3356, 0.106]]),
        temperature_c: None,
        source: "Peter, Über Brechungsindizes und Absorptionskonstanten des Diamanten zwischen 644 und 226 mµ, Z. Phys. 15, 358 (1923)",
        page: "main/C/nk/Peter",
    },
    Glass {
        name: "calcium fluoride",
        aliases: &["CaF2", "fluorite"],
        dispersion: sellmeier(
            [230.0, 9700.0],
            &[[0.567_588_8, 0.050_263_605], [0.471_091_4, 0.100_390_9], [3.848_472_3, 34.64904]],
        ),
        temperature_c: Some(24.0),
        source: "Malitson, A redetermination of some optical properties of calcium fluoride, Appl. Opt. 2, 1103 (1963)",
        page: "main/CaF2/nk/Malitson",
    },
    Glass {
        name: "zinc selenide",
        aliases: &["ZnSe"],
        dispersion: sellmeier(
            [540.0, 18200.0],
            &[[4.458_137_34, 0.200_859_853], [0.467_216_334, 0.391_371_166], [2.895_662_9, 47.136_210_8]],
        ),
        temperature_c: Some(23.0),
        source: "Connolly, diBenedetto and Donadio, Specifications of Raytran material, Proc. SPIE 181, 141 (1979); formula: Tatian, Appl. Opt. 23, 4477 (1984)",
        page: "main/ZnSe/nk/Connolly",
    },
    Glass {
        name: "germanium",
        aliases: &["Ge"],
        dispersion: sellmeier_squared(
            [2000.0, 14000.0],
            &[[0.488_633_1, 1.393_959], [14.514_253_5, 0.162_642_7], [0.009_122_4, 752.19]],
        ),
        temperature_c: Some(22.0),
        source: "Burnett, Kaplan, Stover and Phenis, Refractive index measurements of Ge, Proc. SPIE 9974, 99740X (2016)",
        page: "main/Ge/nk/Burnett",
    },
    Glass {
        name: "air",
        aliases: &[],
        dispersion: gas([230.0, 1690.0], &[[0.057_921_05, 238.0185], [0.001_679_17, 57.362]]),
        temperature_c: Some(15.0),
        source: "dry, 101.325 kPa, 450 ppm CO2, relative to a vacuum; Ciddor, Refractive index of air: new equations for the visible and near infrared, Appl. Opt. 35, 1566 (1996)",
        page: "other/mixed gases/air/nk/Ciddor",
    },
];

const fn sellmeier(range_nm: [f64; 2], terms: &'static [[f64; 2]]) -> Dispersion {
    Dispersion { formula: Formula::Sellmeier(0.0, Cow::Borrowed(terms)), range_nm }
}

const fn sellmeier_squared(range_nm: [f64; 2], terms: &'static [[f64; 2]]) -> Dispersion {
    Dispersion { formula: Formula::SellmeierSquared(0.0, Cow::Borrowed(terms)), range_nm }
}

const fn gas(range_nm: [f64; 2], terms: &'static [[f64; 2]]) -> Dispersion {
    Dispersion { formula: Formula::Gas(0.0, Cow::Borrowed(terms)), range_nm }
}
