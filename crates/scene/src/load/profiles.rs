//! Textures with the light of a lamp: `profile = { ies = "lamp.ies" }`.
//!
//! *In:* a file of IES LM-63. *Out:* a row of texels: texel i of n has the candela at 180 i / (n - 1) degrees from the lamp's axis, in
//! each color channel, as `photometryProfile()` of the library reads them. *Holds:* computed in f64 and rounded once.

use super::Loader;
use crate::model::{Texels, TextureLevel};
use crate::profile::Profile;
use glisten_front::diagnostic::codes::scenes::{SCENE_BAD_ASSET, SCENE_WRONG_KIND, SCENE_WRONG_VALUE};
use glisten_front::hir::{SamplerDim, SamplerType, Scalar};
use glisten_front::source::Span;
use toml::de::DeTable;

/// The keys that only a profile has.
pub(super) const KEYS: &[&str] = &["lumen"];
/// The number of texels, unless the scene gives it, and at most.
const WIDTH: u32 = 181;
const MAX_WIDTH: u32 = 4096;

/// The level for a texture's table with `ies`.
pub(super) fn load(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    name: &str,
    kind: SamplerType,
) -> Option<TextureLevel> {
    let node = table.get("ies")?;
    let span = loader.reader.span_of(node);
    let path = loader.reader.text(node, "ies")?.to_owned();
    if !matches!(kind.dim, SamplerDim::D1 | SamplerDim::D2)
        || kind.arrayed
        || kind.shadow
        || kind.texel != Scalar::Float
    {
        let message = format!("`{name}` is a {}: a profile is a 2D or 1D texture of floats", kind.name());
        loader.reader.error(&SCENE_WRONG_KIND, span, message, "not for this sampler");
        return None;
    }
    let width = loader.reader.count(table, "width", WIDTH, 2..=MAX_WIDTH);
    let profile = read(loader, &path, span)?;
    let factor = factor(loader, table, &profile)?;
    let texel = |at: u32| {
        let candela = factor * profile.candela(180.0 * f64::from(at) / f64::from(width - 1));
        [candela, candela, candela, 1.0].map(|number| number as f32)
    };
    Some(TextureLevel { width, height: 1, depth: 1, texels: Texels::Float((0..width).map(texel).collect()) })
}

fn read(loader: &mut Loader<'_>, path: &str, span: Span) -> Option<Profile> {
    let (path, bytes) = loader.bytes(path, span)?;
    match Profile::parse(&bytes) {
        Ok(profile) => Some(profile),
        Err(error) => {
            loader.reader.error(&SCENE_BAD_ASSET, span, format!("`{path}`: {error}"), "not a profile that can be read");
            None
        }
    }
}

/// The factor for all of the light to be what the scene says: `lumen`.
fn factor(loader: &mut Loader<'_>, table: &DeTable<'_>, profile: &Profile) -> Option<f64> {
    let Some(node) = table.get("lumen") else { return Some(1.0) };
    let lumen = loader.reader.finite(node, "lumen")?;
    let factor = lumen / profile.lumen();
    if (0.0..=1e9).contains(&factor) {
        return Some(factor);
    }
    let span = loader.reader.span_of(node);
    let message = "`lumen` is from 0 on, for a lamp that shines";
    loader.reader.error(&SCENE_WRONG_VALUE, span, message.to_owned(), "not for this profile");
    None
}
