//! The textures that a scene begins with, by the kinds and names of samplers.
//!
//! *In:* a sampler. *Out:* its table of `[draw.textures]`. *Holds:* a texture that is read with coordinates from 0 to 1 has no single
//! color, unless its name says that it is a map of normals or the like.

use super::choice::Taste;
use glisten_front::hir::{SamplerDim, SamplerType, Scalar};

/// Words in names, with the texture for a 2D sampler of floats.
static BY_NAME: &[(&[&str], &str)] = &[
    (&["p_tex", "ptex", "gposition", "positionmap", "positiontex", "postex", "positionbuffer"], POSITIONS),
    (&["gnormal", "normalbuffer", "viewnormal"], "{ pattern = \"plain\", to = [0.0, 0.0, 1.0] }"),
    (&["n_tex", "ntex", "normal", "bump", "nrm", "norm"], "{ pattern = \"plain\", to = [0.5, 0.5, 1.0] }"),
    (
        &["shadow", "depth", "d_tex", "dtex"],
        "{ pattern = \"checker\", cells = 2, from = [0.2, 0.2, 0.2], to = [0.9, 0.9, 0.9] }",
    ),
    (&["metal"], "{ pattern = \"plain\", to = [0.2, 0.2, 0.2] }"),
    (&["rough"], "{ pattern = \"plain\", to = [0.4, 0.4, 0.4] }"),
    (&["occlusion", "aomap", "texao", "ssao", "lightmap", "sampler2", "overlay"], "{ pattern = \"plain\" }"),
    (&["emissi", "emission"], "{ pattern = \"plain\", to = [0.0, 0.0, 0.0] }"),
    (
        &["brdf", "lut", "ramp", "gradient", "toon", "palette"],
        "{ pattern = \"hemisphere\", width = 64, height = 64, filter = \"linear\" }",
    ),
    (
        &[
            "screen",
            "scene",
            "frame",
            "buffer",
            "image",
            "source",
            "input",
            "insampler",
            "blur",
            "bloom",
            "hdr",
            "rt",
            "color",
            "sky",
            "env",
            "panorama",
            "reflect",
            "refract",
            "video",
            "diffusesampler",
            "channel",
            "noise",
            "height",
            "disp",
        ],
        IMAGE,
    ),
];

const PLAIN: &str = "pattern = \"plain\"";
const IMAGE: &str = "{ pattern = \"sky\", width = 256, height = 256, filter = \"linear\" }";
/// A picture of two colors.
pub(super) const CHECKER: &str = "{ pattern = \"checker\", from = [0.25, 0.35, 0.6], to = [0.95, 0.8, 0.5] }";
const OTHER_IMAGE: &str = "{ pattern = \"sky\", from = [0.9, 0.6, 0.3], to = [0.3, 0.2, 0.4], width = 256, height = 256, filter = \"linear\" }";
const OTHER_CHECKER: &str = "{ pattern = \"checker\", cells = 5, from = [0.2, 0.5, 0.3], to = [0.9, 0.9, 0.8] }";
const POSITIONS: &str = "{ width = 2, height = 2, filter = \"linear\", values = \
    [-1.0, -1.0, -2.0, 1.0, 1.0, -1.0, -2.0, 1.0, -1.0, 1.0, -2.0, 1.0, 1.0, 1.0, -2.0, 1.0] }";

/// All four channels differ, also alpha.
const TRANSLUCENT: &str = "{ width = 4, height = 4, filter = \"linear\", values = [\
    0.9, 0.5, 0.4, 1.0,  0.2, 0.7, 0.9, 0.4,  0.6, 0.8, 1.0, 0.8,  0.1, 0.3, 0.2, 0.1, \
    0.4, 0.1, 0.8, 0.2,  0.9, 0.8, 0.5, 0.9,  0.3, 0.6, 0.1, 0.5,  0.7, 0.4, 0.7, 0.7, \
    0.2, 0.9, 0.3, 0.6,  0.5, 0.2, 0.6, 0.1,  1.0, 0.7, 0.2, 1.0,  0.1, 0.1, 0.9, 0.3, \
    0.8, 0.3, 0.1, 0.8,  0.3, 1.0, 0.7, 0.5,  0.6, 0.2, 0.9, 0.2,  0.9, 0.9, 0.8, 0.9] }";

/// The reasons for a texture that a sampler's name does not give.
#[derive(Clone, Copy, Debug)]
pub(super) struct Needs {
    pub(super) taste: Taste,
    /// The number of the sampler: two of them have different textures.
    pub(super) number: usize,
    /// Whether texels are fetched by integers.
    pub(super) is_fetched: bool,
}

/// The table for a sampler; one that is fetched from by integers is as large as a window. For tastes other than the first one, a 2D texture has structure whatever its name says.
pub(super) fn table(name: &str, kind: SamplerType, needs: Needs) -> String {
    let is_flat = matches!(kind.dim, SamplerDim::D2) && !kind.arrayed && !kind.shadow && kind.texel == Scalar::Float;
    if is_flat {
        match needs.taste.0 {
            0 => {}
            1 => return of_number(IMAGE, needs.number),
            2 => return TRANSLUCENT.to_owned(),
            _ => return POSITIONS.to_owned(),
        }
        let small = name.to_ascii_lowercase();
        let found = BY_NAME.iter().find(|(words, _)| words.iter().any(|word| small.contains(word)));
        return match found.map_or(CHECKER, |(_, table)| table) {
            POSITIONS if needs.is_fetched => of_number(IMAGE, needs.number),
            table if needs.is_fetched => table.replace(PLAIN, &format!("{PLAIN}, width = 256, height = 256")),
            table => of_number(table, needs.number),
        };
    }
    if matches!(kind.dim, SamplerDim::D1) && !kind.arrayed && !kind.shadow && kind.texel == Scalar::Float {
        return "{ pattern = \"hemisphere\", width = 64, filter = \"linear\" }".to_owned();
    }
    crate::texels::values(kind)
}

/// The pictures of every other sampler are others.
fn of_number(table: &str, number: usize) -> String {
    match (table, number % 2) {
        (IMAGE, 1) => OTHER_IMAGE.to_owned(),
        (CHECKER, 1) => OTHER_CHECKER.to_owned(),
        _ => table.to_owned(),
    }
}
