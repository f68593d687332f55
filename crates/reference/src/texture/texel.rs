//! Accesses texels by integer coordinates.

use super::{BoundedFloat, BoundedInt, Sampled};
use glisten_front::hir::{SamplerDim, SamplerType};
use glisten_scene::{Texels, Texture, TextureLevel};

/// The index of a texel in its level; `None` outside.
#[inline]
pub(super) fn place(level: &TextureLevel, at: [i64; 3]) -> Option<usize> {
    let inside = |k: i64, count: u32| (0..i64::from(count)).contains(&k);
    let [x, y, z] = at;
    let all = inside(x, level.width) && inside(y, level.height) && inside(z, level.depth);
    all.then(|| ((z as usize * level.height as usize) + y as usize) * level.width as usize + x as usize)
}

/// A texel as floats; (0, 0, 0, 0) outside.
#[inline]
pub(super) fn floats(level: &TextureLevel, at: [i64; 3]) -> [f64; 4] {
    let Some(place) = place(level, at) else { return [0.0; 4] };
    match &level.texels {
        Texels::Float(texels) => texels.get(place).map_or([0.0; 4], |texel| texel.map(f64::from)),
        Texels::Int(texels) => texels.get(place).map_or([0.0; 4], |texel| texel.map(f64::from)),
        Texels::Uint(texels) => texels.get(place).map_or([0.0; 4], |texel| texel.map(f64::from)),
    }
}

/// A texel's bits as integers; 0 outside.
pub(super) fn bits(level: &TextureLevel, at: [i64; 3]) -> [u32; 4] {
    let Some(place) = place(level, at) else { return [0; 4] };
    match &level.texels {
        Texels::Float(texels) => texels.get(place).map_or([0; 4], |texel| texel.map(|value| value as i32 as u32)),
        Texels::Int(texels) => texels.get(place).map_or([0; 4], |texel| texel.map(|value| value as u32)),
        Texels::Uint(texels) => texels.get(place).copied().unwrap_or([0; 4]),
    }
}

/// The level and the texel that `texelFetch` reads: coordinates in texels of the level, the layer last. `None` past the last level.
fn fetched<'a>(
    texture: &'a Texture,
    kind: SamplerType,
    at: &[i32],
    level: i32,
    offset: &[i32],
) -> Option<(&'a TextureLevel, [i64; 3])> {
    let dimensions = usize::from(kind.dimensions());
    let mut place = [0i64; 3];
    for (axis, to) in place.iter_mut().enumerate().take(dimensions) {
        let moved = offset.get(axis).copied().unwrap_or(0);
        *to = i64::from(at.get(axis).copied().unwrap_or(0)) + i64::from(moved);
    }
    if kind.arrayed {
        place[2] = i64::from(at.get(dimensions).copied().unwrap_or(0));
    }
    let level = usize::try_from(level).ok().and_then(|level| texture.levels.get(level))?;
    Some((level, place))
}

/// `texelFetch`.
pub(crate) fn fetch(texture: &Texture, kind: SamplerType, at: &[i32], level: i32, offset: &[i32]) -> Sampled {
    let Some((level, place)) = fetched(texture, kind, at, level, offset) else { return nothing(kind) };
    if kind.texel == glisten_front::hir::Scalar::Float {
        Sampled::Floats(floats(level, place).map(BoundedFloat::exact))
    } else {
        Sampled::Ints(bits(level, place).map(BoundedInt::exact))
    }
}

/// `texelFetch` of floats, as numbers alone.
#[inline]
pub(crate) fn fetch_floats(
    texture: &Texture,
    kind: SamplerType,
    at: [i32; 3],
    level: i32,
    offset: [i32; 3],
) -> [f64; 4] {
    fetched(texture, kind, &at, level, &offset).map_or([0.0; 4], |(level, place)| floats(level, place))
}

fn nothing(kind: SamplerType) -> Sampled {
    if kind.texel == glisten_front::hir::Scalar::Float {
        Sampled::Floats([BoundedFloat::default(); 4])
    } else {
        Sampled::Ints([BoundedInt::default(); 4])
    }
}

/// `textureSize`: the size of a level, with the number of layers last; 0 past the last level.
pub(crate) fn size(texture: &Texture, kind: SamplerType, level: i32) -> [u32; 3] {
    let found = usize::try_from(level).ok().and_then(|level| texture.levels.get(level));
    let Some(level) = found else { return [0; 3] };
    let layers = if kind.dim == SamplerDim::Cube { level.depth / 6 } else { level.depth };
    match (kind.dim, kind.arrayed) {
        (SamplerDim::D1 | SamplerDim::Buffer, true) => [level.width, layers, 0],
        (SamplerDim::D1 | SamplerDim::Buffer, false) => [level.width, 0, 0],
        (SamplerDim::D3, _) | (_, true) => [level.width, level.height, layers],
        _ => [level.width, level.height, 0],
    }
}
