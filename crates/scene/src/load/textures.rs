//! Loads `[draw.textures]` as [`Texture`]s.

use super::depths::{self, DepthMap, Waiting};
use super::layers;
use super::material::has_texture;
use super::mipmaps::chain;
use super::names::{FILTERS, TEXTURE_KINDS, TextureKind, kind_name};
use super::paste::{self, Lines};
use super::{ENVIRONMENT, Loader, patterns, profiles};
use crate::geometry::gltf_image;
use crate::model::{Compare, Filter, Sampling, Texels, Texture, TextureLevel, Wrap};
use crate::picture::{Image, Transfer};
use crate::tables::{Node, Number, NumberValue, report_unknown_name};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::{
    SCENE_BAD_ASSET, SCENE_UNREAD_KEY, SCENE_UNSET_TEXTURE, SCENE_WRONG_KIND, SCENE_WRONG_SIZE, SCENE_WRONG_VALUE,
};
use glisten_front::hir::{SamplerDim, SamplerType, Scalar, Type};
use glisten_front::link::Program;
use glisten_front::source::Span;
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeString, DeTable};

const KEYS: &[&str] = &[
    "kind",
    "integer",
    "width",
    "height",
    "depth",
    "layers",
    "values",
    "filter",
    "wrap",
    "mipmaps",
    "compare",
    "file",
    "image",
    "flip",
    "pattern",
    "depths",
    "ies",
    "samples",
    "decode",
    "lod_bias",
    "magnify",
    "fixed_point",
    "transform",
];

/// The largest width, height, depth or number of layers.
const MAX_SIDE: u32 = 8192;
/// The largest number of samples of a texel. A shader can ask for no more on any driver.
const MAX_SAMPLES: u32 = 32;
/// The largest number of texels of a texture's first level.
const MAX_TEXELS: u64 = 1 << 25;
/// The largest number of texels of the first levels of all textures that imported draws have.
const MAX_SHARED_TEXELS: u64 = 1 << 27;

/// The texture of each sampler slot of the program, in order: the draw's own, or the material's, or the scene's environment, or, for a sampler of
/// one of the library's programs (`conventional`), a white one.
pub(super) fn load_textures(
    loader: &mut Loader<'_>,
    (draw, material, environment): (&DeTable<'_>, Option<&DeTable<'_>>, Option<&Node<'_>>),
    program: &Program,
    (conventional, maps): (bool, &[DepthMap]),
    place: Span,
) -> Vec<Option<Arc<Texture>>> {
    let slots = &program.interface.samplers;
    let names: Vec<&str> = slots.iter().map(|slot| slot.name.as_str()).collect();
    let kinds: Vec<SamplerType> = slots
        .iter()
        .map(|slot| match program.types.get(slot.ty) {
            Type::Sampler(kind) => kind,
            _ => SamplerType { texel: Scalar::Float, dim: SamplerDim::D2, arrayed: false, shadow: false },
        })
        .collect();
    let mut textures: Vec<Option<Arc<Texture>>> = vec![None; slots.len()];
    let mut given = vec![false; slots.len()];
    if let Some(table) = loader.reader.table_at(draw, "textures") {
        for (name, node) in table {
            let name_text: &str = name.get_ref();
            let index = slots.iter().position(|slot| {
                slot.name == name_text || (slot.array_size.is_some() && slot.name == format!("{name_text}[0]"))
            });
            let Some(index) = index else {
                let span = loader.reader.span_of(name);
                // The sampler that a misspelled name is most similar to counts as given.
                let near = report_unknown_name(&mut loader.reader, span, "sampler", name_text, &names);
                let meant = near.and_then(|near| slots.iter().position(|slot| slot.name == near));
                if let Some(flag) = meant.and_then(|meant| given.get_mut(meant)) {
                    *flag = true;
                }
                continue;
            };
            if let (Some(flag), Some(slot), Some(&kind)) =
                (given.get_mut(index), textures.get_mut(index), kinds.get(index))
            {
                *flag = true;
                *slot = shared_texture(loader, node, name_text, kind);
                if let Some(map) = maps.iter().find(|map| map.name == name_text) {
                    loader.waiting.push(Waiting::new(loader.casters.len(), index, map));
                }
            }
        }
    }
    for ((slot, texture), (given, &kind)) in slots.iter().zip(&mut textures).zip(given.iter_mut().zip(&kinds)) {
        let Some(node) = material.and_then(|material| material.get(slot.name.as_str())) else { continue };
        if !*given && has_texture(&slot.name) {
            *given = true;
            *texture = shared_texture(loader, node, &slot.name, kind);
        }
    }
    for ((slot, texture), (given, &kind)) in slots.iter().zip(&mut textures).zip(given.iter_mut().zip(&kinds)) {
        if let Some(node) = environment.filter(|_| !*given && slot.name == ENVIRONMENT) {
            *given = true;
            *texture = surroundings(loader, node, kind);
        }
    }
    warn_unplaced(loader, (draw, material), program);
    let mut unset = Vec::new();
    for (((slot, texture), given), kind) in slots.iter().zip(&mut textures).zip(given).zip(kinds) {
        if given {
            continue;
        }
        if slot.active && !conventional {
            unset.push((slot.name.as_str(), kind));
        }
        let table = layers::TABLES.iter().find(|(sampler, _)| conventional && *sampler == slot.name);
        *texture = Some(match table {
            Some((_, pattern)) => made_table(loader, pattern, kind),
            None => Arc::new(Texture::unset(kind, if conventional { 1 } else { 0 })),
        });
    }
    warn_unset(loader, draw, &unset, place);
    textures
}

/// The map of an environment, which all draws share: squares on top of each other.
fn surroundings(loader: &mut Loader<'_>, node: &Node<'_>, kind: SamplerType) -> Option<Arc<Texture>> {
    if let Some(known) = &loader.environment {
        return known.clone();
    }
    let texture = load_texture(loader, node, ENVIRONMENT, kind).map(Arc::new);
    let level = texture.as_ref().and_then(|texture| texture.levels.first());
    let wrong = level.filter(|level| level.height % level.width.max(1) != 0).map(|level| (level.width, level.height));
    if let Some((width, height)) = wrong {
        let span = loader.reader.span_of(node);
        let message = format!("a map of {width}x{height} texels has no squares on top of each other");
        let diagnostic = Diagnostic::new(&SCENE_WRONG_SIZE, span, message).here("not light from all around");
        loader.reader.report(diagnostic.help("`glisten lib prefilter` makes the map of a panorama"));
    }
    let texture = texture.filter(|_| wrong.is_none());
    loader.environment = Some(texture.clone());
    texture
}

/// The table of a sampler of the library's programs, which all draws share.
fn made_table(loader: &mut Loader<'_>, pattern: &'static str, kind: SamplerType) -> Arc<Texture> {
    let made = loader.tables.entry(pattern).or_insert_with(|| {
        let levels = patterns::by_default(pattern).into_iter().collect();
        let (wrap, sampling) = (Wrap::ClampToEdge, Sampling::default());
        Arc::new(Texture { kind, levels, filter: Filter::Nearest, wrap, compare: Compare::Lequal, sampling })
    });
    Arc::clone(made)
}

/// Warns about transforms of textures that the program does not know: they belong to a material of the program `standard`.
fn warn_unplaced(loader: &mut Loader<'_>, (draw, material): (&DeTable<'_>, Option<&DeTable<'_>>), program: &Program) {
    let own = draw.get("textures").and_then(|node| node.get_ref().as_table());
    for (name, node) in own.into_iter().chain(material).flatten() {
        let Some((key, _)) = node.get_ref().as_table().and_then(|table| table.get_key_value("transform")) else {
            continue;
        };
        let member = format!("places.{}.s", name.get_ref());
        let is_known = program.interface.uniforms.iter().any(|leaf| leaf.name == member);
        if is_known && own.is_none_or(|own| !own.contains_key(name.get_ref().as_ref())) {
            continue;
        }
        let span = loader.reader.span_of(key);
        let message = format!("nothing reads the `transform` of `{}`", name.get_ref());
        let diagnostic = Diagnostic::new(&SCENE_UNREAD_KEY, span, message).here("changes nothing");
        loader
            .reader
            .report_missing(diagnostic.help("a material of the program `standard` has transforms of its textures"));
    }
}

/// Warns about samplers without a texture, with lines to paste: the smallest textures that say the same.
fn warn_unset(loader: &mut Loader<'_>, draw: &DeTable<'_>, unset: &[(&str, SamplerType)], place: Span) {
    let names: Vec<&str> = unset.iter().map(|(name, _)| *name).collect();
    let message = match names.len() {
        0 => return,
        1 => format!("sampler {} gets no texture: it reads (0, 0, 0, 1) everywhere", paste::names(&names)),
        _ => format!("samplers {} get no texture: they read (0, 0, 0, 1) everywhere", paste::names(&names)),
    };
    let lines = unset.iter().map(|(name, kind)| format!("{} = {}", paste::key(name), smallest(*kind)));
    let help = paste::help(&loader.reader, draw, &[Lines::new("textures", lines.collect())]);
    loader.reader.report_missing(Diagnostic::new(&SCENE_UNSET_TEXTURE, place, message).maybe_help(help));
}

/// The smallest texture of a kind, black.
fn smallest(kind: SamplerType) -> String {
    let size = match kind.dim {
        SamplerDim::D1 | SamplerDim::Buffer => "width = 1",
        SamplerDim::D3 => "width = 1, height = 1, depth = 1",
        SamplerDim::Cube => "width = 1",
        _ => "width = 1, height = 1",
    };
    let layers = if kind.arrayed { ", layers = 1" } else { "" };
    let texel = if kind.texel == Scalar::Float { "0.0, 0.0, 0.0, 1.0" } else { "0, 0, 0, 1" };
    let texels = if kind.dim == SamplerDim::Cube { 6 } else { 1 };
    format!("{{ {size}{layers}, values = [{}] }}", vec![texel; texels].join(",  "))
}

/// A texture, which the draws of a file share: the file, and not the scene, says how often it is there.
fn shared_texture(loader: &mut Loader<'_>, node: &Node<'_>, name: &str, kind: SamplerType) -> Option<Arc<Texture>> {
    // Wherever it is placed, the texture is the same.
    let is_own = |(key, _): &(&Spanned<DeString<'_>>, _)| key.get_ref() != "transform";
    let parts = node.get_ref().as_table().map(|table| table.iter().filter(is_own).collect::<Vec<_>>());
    let key = format!("{kind:?} {parts:?}");
    if let Some(known) = loader.shared.as_ref().and_then(|(known, _)| known.get(&key)) {
        return known.clone();
    }
    let texture = load_texture(loader, node, name, kind).map(Arc::new);
    let Some((known, n_texels)) = loader.shared.as_mut() else { return texture };
    let texels = |level: &TextureLevel| u64::from(level.width) * u64::from(level.height) * u64::from(level.depth);
    *n_texels += texture.as_ref().and_then(|texture| texture.levels.first()).map_or(0, texels);
    let is_too_much = *n_texels > MAX_SHARED_TEXELS;
    let texture = texture.filter(|_| !is_too_much);
    known.insert(key, texture.clone());
    if is_too_much {
        let span = loader.reader.span_of(node);
        let message = format!("the textures of a scene's files have at most {MAX_SHARED_TEXELS} texels together");
        loader.reader.error(&SCENE_WRONG_SIZE, span, message, "too many");
    }
    texture
}

fn load_texture(loader: &mut Loader<'_>, node: &Node<'_>, name: &str, kind: SamplerType) -> Option<Texture> {
    let table = loader.reader.table(node, name)?;
    let span = loader.reader.span_of(node);
    let pattern = patterns::find(table);
    let more = match () {
        () if table.contains_key("pattern") => patterns::KEYS,
        () if table.contains_key("ies") => profiles::KEYS,
        () => &[],
    };
    let keys = [KEYS, more].concat();
    loader.reader.check_keys(table, "a texture", &keys);
    check_origin(loader, table)?;
    check_kind(loader, table, name, kind)?;
    let filter = loader.reader.choice_at(table, "filter", Filter::Nearest, FILTERS);
    let clamps = kind.dim == SamplerDim::Rect || table.contains_key("ies");
    let own_wrap = if clamps { Wrap::ClampToEdge } else { Wrap::Repeat };
    let default_wrap = pattern.map_or(own_wrap, |pattern| pattern.wrap());
    let wrap = loader.reader.choice_at(table, "wrap", default_wrap, Wrap::NAMES);
    let compare = loader.reader.choice_at(table, "compare", Compare::Lequal, Compare::NAMES);
    let sampling = load_sampling(loader, table, name, kind, filter)?;
    let mipmaps = loader.reader.flag(table, "mipmaps", false);
    check_state(loader, table, name, kind, (filter, wrap, mipmaps))?;
    let level = match (table.get("file"), table.get("pattern")) {
        _ if table.contains_key("ies") => profiles::load(loader, table, name, kind)?,
        _ if table.contains_key("depths") => {
            let levels = depths::blank(loader, table, name, kind, mipmaps)?;
            return Some(Texture { kind, levels, filter, wrap, compare, sampling });
        }
        (Some(file), _) => load_image(loader, table, file, name, kind)?,
        (None, Some(pattern)) => patterns::load(loader, table, pattern, name, kind)?,
        (None, None) if kind.dim == SamplerDim::Multisample => {
            let levels = load_samples(loader, table, span, name, kind)?;
            return Some(Texture { kind, levels, filter, wrap, compare, sampling });
        }
        (None, None) => load_level(loader, table, span, name, kind)?,
    };
    let levels = if mipmaps { chain(level, kind) } else { vec![level] };
    Some(Texture { kind, levels, filter, wrap, compare, sampling })
}

/// Whether magnification is linear, by name.
const MAGNIFICATION: &[(&str, bool)] = &[("nearest", false), ("linear", true)];

/// The parameters that few textures have.
fn load_sampling(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    name: &str,
    kind: SamplerType,
    filter: Filter,
) -> Option<Sampling> {
    let bias = table.get("lod_bias").and_then(|node| loader.reader.finite(node, "lod_bias"));
    let sampling = Sampling {
        lod_bias: bias.unwrap_or(0.0) as f32,
        magnify_linear: table.get("magnify").and_then(|node| loader.reader.choice(node, "magnify", MAGNIFICATION)),
        fixed_point_depth: loader.reader.flag(table, "fixed_point", false),
    };
    let key = if sampling.fixed_point_depth && !kind.shadow {
        ("fixed_point", "is no shadow sampler, and only depth is stored as fixed-point numbers")
    } else if table.contains_key("compare") && !kind.shadow {
        ("compare", "is no shadow sampler, and compares nothing")
    } else if sampling.lod_bias != 0.0 && !kind.has_levels() {
        ("lod_bias", "has no levels of detail")
    } else if sampling.has_two_filters(filter) && !kind.is_filtered() {
        ("magnify", "cannot be filtered")
    } else {
        return Some(sampling);
    };
    let span = table.get(key.0).map_or_else(Span::default, |node| loader.reader.span(node.span()));
    let message = format!("`{name}` is a {}, which {}", kind.name(), key.1);
    loader.reader.error(&SCENE_WRONG_VALUE, span, message, "not for this sampler");
    None
}

/// Checks that the texels come from exactly one origin.
fn check_origin(loader: &mut Loader<'_>, table: &DeTable<'_>) -> Option<()> {
    let origins = ["values", "file", "pattern", "depths", "ies"].map(|key| table.get_key_value(key));
    let mut given = origins.into_iter().flatten();
    if let (Some((first, _)), Some((second, _))) = (given.next(), given.next()) {
        let span = loader.reader.span_of(second);
        let message = format!("a texture with `{}` has no `{}`", first.get_ref(), second.get_ref());
        loader.reader.error(&SCENE_WRONG_VALUE, span, message, "leave one of the two out");
        return None;
    }
    if let (None, Some((key, _))) = (table.get("file"), table.get_key_value("decode")) {
        let span = loader.reader.span_of(key);
        let message = "`decode` is for an image file: other texels are linear light".to_owned();
        loader.reader.error(&SCENE_WRONG_VALUE, span, message, "nothing to decode");
        return None;
    }
    Some(())
}

fn check_kind(loader: &mut Loader<'_>, table: &DeTable<'_>, name: &str, sampler: SamplerType) -> Option<()> {
    let wanted: TextureKind = (sampler.dim, sampler.arrayed, sampler.shadow);
    if let Some(node) = table.get("kind") {
        let kind = loader.reader.choice(node, "kind", TEXTURE_KINDS)?;
        // `shadow_` may be omitted: the type of the sampler implies it.
        let agrees = kind == wanted || (kind.0, kind.1, true) == wanted;
        if !agrees {
            let span = loader.reader.span(node.span());
            let message = format!("`{name}` is a {}: its texture is of kind `{}`", sampler.name(), kind_name(wanted));
            loader.reader.error(&SCENE_WRONG_KIND, span, message, "contradicts the shader");
            return None;
        }
    }
    let integer = matches!(sampler.texel, Scalar::Int | Scalar::Uint);
    if let Some(node) = table.get("integer")
        && loader.reader.flag(table, "integer", integer) != integer
    {
        let span = loader.reader.span(node.span());
        let message = format!("`{name}` is a {}", sampler.name());
        loader.reader.error(&SCENE_WRONG_KIND, span, message, "contradicts the shader");
        return None;
    }
    Some(())
}

/// Reports combinations of state that OpenGL calls incomplete (OpenGL 3.2 §3.8.12) or rejects.
fn check_state(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    name: &str,
    kind: SamplerType,
    (filter, wrap, mipmaps): (Filter, Wrap, bool),
) -> Option<()> {
    let integer = matches!(kind.texel, Scalar::Int | Scalar::Uint);
    let unfiltered = matches!(kind.dim, SamplerDim::Rect | SamplerDim::Buffer | SamplerDim::Multisample);
    let fetched = kind.dim == SamplerDim::Multisample;
    let (key, message) = if fetched && filter != Filter::Nearest {
        ("filter", format!("`{name}` is a {}, whose samples cannot be filtered", kind.name()))
    } else if kind.dim == SamplerDim::Buffer && filter != Filter::Nearest {
        ("filter", format!("`{name}` is a {}, which cannot be filtered", kind.name()))
    } else if kind.dim == SamplerDim::Rect && filter.uses_levels() {
        ("filter", format!("`{name}` is a {}, which has no mipmaps: its filter is `nearest` or `linear`", kind.name()))
    } else if integer && !matches!(filter, Filter::Nearest | Filter::NearestMipmapNearest) {
        ("filter", format!("`{name}` holds integers, of which OpenGL reads the nearest one alone"))
    } else if kind.dim == SamplerDim::Rect && wrap != Wrap::ClampToEdge {
        ("wrap", format!("`{name}` is a {}, which can only clamp", kind.name()))
    } else if mipmaps && integer {
        ("mipmaps", format!("`{name}` holds integers, of which there is no mean for mipmaps"))
    } else if mipmaps && unfiltered {
        ("mipmaps", format!("`{name}` is a {}, which has no mipmaps", kind.name()))
    } else {
        return Some(());
    };
    let span = table.get(key).map_or_else(Span::default, |node| loader.reader.span(node.span()));
    loader.reader.error(&SCENE_WRONG_VALUE, span, message, "not for this sampler");
    None
}

/// The image of each sample of a multisample texture: the values are sample by sample within a texel.
fn load_samples(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    span: Span,
    name: &str,
    kind: SamplerType,
) -> Option<Vec<TextureLevel>> {
    let (numbers, values) = load_values(loader, table, span, name)?;
    let (width, height, depth) = load_size(loader, table, span, name, kind, 0)?;
    let texels = width as usize * height as usize * depth as usize;
    let fitting = (numbers.len() / (4 * texels)).clamp(1, MAX_SAMPLES as usize) as u32;
    let samples = loader.reader.count(table, "samples", fitting, 1..=MAX_SAMPLES) as usize;
    if texels.saturating_mul(samples) as u64 > MAX_TEXELS {
        let message = format!("`{name}` has {texels} texels of {samples} samples; at most {MAX_TEXELS} are drawn with");
        loader.reader.error(&SCENE_WRONG_SIZE, span, message, "too large");
        return None;
    }
    if numbers.len() != texels * samples * 4 {
        let wanted = texels * samples * 4;
        let message = format!(
            "`{name}` is {texels} texels of {samples} samples of RGBA, which takes {wanted} numbers, not {}",
            numbers.len()
        );
        loader.reader.error(&SCENE_WRONG_SIZE, values, message, &format!("expected {wanted} numbers"));
        return None;
    }
    let all = load_texels(loader, name, kind, 4, &numbers)?;
    let image = |sample: usize| TextureLevel { width, height, depth, texels: every(&all, samples, sample) };
    Some((0..samples).map(image).collect())
}

/// Every `step`th texel from `first` on.
fn every(texels: &Texels, step: usize, first: usize) -> Texels {
    fn pick<T: Copy>(texels: &[T], step: usize, first: usize) -> Vec<T> {
        texels.iter().skip(first).step_by(step).copied().collect()
    }
    match texels {
        Texels::Float(texels) => Texels::Float(pick(texels, step, first)),
        Texels::Int(texels) => Texels::Int(pick(texels, step, first)),
        Texels::Uint(texels) => Texels::Uint(pick(texels, step, first)),
    }
}

/// The width, height and depth of the first level; the number of `values` determines a size that is omitted.
fn load_size(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    span: Span,
    name: &str,
    kind: SamplerType,
    values: u32,
) -> Option<(u32, u32, u32)> {
    let reader = &mut loader.reader;
    let mut side = |key: &str, used: bool, default: u32, limit: u32| {
        if !used && table.get(key).is_some_and(|node| node.get_ref().as_integer().is_none_or(|n| n.as_str() != "1")) {
            let span = table.get(key).map_or(span, |node| reader.span(node.span()));
            let message = format!("`{name}` is a {}, which has no `{key}`", kind.name());
            reader.error(&SCENE_WRONG_VALUE, span, message, "not for this sampler");
        }
        if used { reader.count(table, key, default, 1..=limit) } else { 1 }
    };
    let flat = matches!(kind.dim, SamplerDim::D1 | SamplerDim::Buffer);
    let is_cube = kind.dim == SamplerDim::Cube;
    let limit = if kind.dim == SamplerDim::Buffer { MAX_TEXELS as u32 } else { MAX_SIDE };
    // An array's layers may be told as its depth.
    let by_depth = kind.arrayed && table.get("layers").is_none() && table.get("depth").is_some();
    let layers = side(if by_depth { "depth" } else { "layers" }, kind.arrayed, 1, MAX_SIDE);
    let depth = if by_depth { 1 } else { side("depth", kind.dim == SamplerDim::D3, 1, MAX_SIDE) };
    let alone = flat && !kind.arrayed;
    if kind.dim != SamplerDim::Multisample {
        side("samples", false, 1, 1);
    }
    let width = side("width", true, if alone { values.max(1) } else { 0 }, limit);
    let height = side("height", !flat, if is_cube { width } else { 0 }, MAX_SIDE);
    if width == 0 || height == 0 {
        let key = if width == 0 { "width" } else { "height" };
        // A number that is none was reported.
        if table.contains_key(key) || loader.reader.is_misspelled(table, key) {
            return None;
        }
        loader.missing_key(span, &format!("texture `{name}` has no `{key}`"), &format!("add `{key} = ...`"));
        return None;
    }
    if is_cube && width != height {
        let message = format!("`{name}` is a {}: its faces are square", kind.name());
        loader.reader.error(&SCENE_WRONG_SIZE, span, message, "width and height differ");
        return None;
    }
    let depth = if is_cube { 6 * layers } else { depth * layers };
    let texels = u64::from(width) * u64::from(height) * u64::from(depth);
    if texels > MAX_TEXELS {
        let message = format!("`{name}` has {texels} texels; at most {MAX_TEXELS} are drawn with");
        loader.reader.error(&SCENE_WRONG_SIZE, span, message, "too large");
        return None;
    }
    Some((width, height, depth))
}

/// The numbers under `values`, and their span.
fn load_values(loader: &mut Loader<'_>, table: &DeTable<'_>, span: Span, name: &str) -> Option<(Vec<Number>, Span)> {
    let Some(values) = table.get("values") else {
        if !["values", "file", "pattern"].iter().any(|key| loader.reader.is_misspelled(table, key)) {
            let message = format!("texture `{name}` has no `values`");
            loader.missing_key(span, &message, "add `values = [r, g, b, a, ...]`, `file` or `pattern`");
        }
        return None;
    };
    let numbers = loader.reader.numbers(values, "values")?;
    Some((numbers, loader.reader.span_of(values)))
}

fn load_level(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    span: Span,
    name: &str,
    kind: SamplerType,
) -> Option<TextureLevel> {
    let (numbers, values) = load_values(loader, table, span, name)?;
    let (width, height, depth) = load_size(loader, table, span, name, kind, numbers.len() as u32 / 4)?;
    let texels = width as usize * height as usize * depth as usize;
    let each = match numbers.len() {
        n if n == texels * 4 => 4,
        n if n == texels && kind.shadow => 1,
        n => {
            let span = values;
            let shape = if depth > 1 { format!("{width}x{height}x{depth}") } else { format!("{width}x{height}") };
            let message = format!("`{name}` is {shape} texels of RGBA, which takes {} numbers, not {n}", texels * 4);
            loader.reader.error(&SCENE_WRONG_SIZE, span, message, &format!("expected {} numbers", texels * 4));
            return None;
        }
    };
    let texels = load_texels(loader, name, kind, each, &numbers)?;
    Some(TextureLevel { width, height, depth, texels })
}

fn load_texels(
    loader: &mut Loader<'_>,
    name: &str,
    kind: SamplerType,
    each: usize,
    numbers: &[Number],
) -> Option<Texels> {
    let refused = |number: &Number| {
        matches!(
            (kind.texel, number.value),
            (_, NumberValue::Bool(_)) | (Scalar::Int | Scalar::Uint, NumberValue::Float(_))
        )
    };
    let in_range = |number: &Number| match (kind.texel, number.value) {
        (Scalar::Int, NumberValue::Int(value, _)) => i32::try_from(value).is_ok(),
        (Scalar::Uint, NumberValue::Int(value, _)) => u32::try_from(value).is_ok(),
        _ => true,
    };
    if let Some(number) = numbers.iter().find(|number| refused(number) || !in_range(number)) {
        let message = format!("`{name}` is a {}, and this is not a texel of it", kind.name());
        loader.reader.error(&SCENE_WRONG_KIND, number.span, message, "expected another kind of number");
        return None;
    }
    let int = |number: &Number| match number.value {
        NumberValue::Int(value, _) => value,
        NumberValue::Bool(_) | NumberValue::Float(_) => 0,
    };
    let float = |number: &Number| match number.value {
        NumberValue::Int(_, value) | NumberValue::Float(value) => value,
        NumberValue::Bool(_) => 0.0,
    };
    Some(match kind.texel {
        Scalar::Int => Texels::Int(gather(numbers, each, [0, 0, 0, 1], |number| int(number) as i32)),
        Scalar::Uint => Texels::Uint(gather(numbers, each, [0, 0, 0, 1], |number| int(number) as u32)),
        Scalar::Float | Scalar::Bool => Texels::Float(gather(numbers, each, [0.0, 0.0, 0.0, 1.0], float)),
    })
}

fn gather<T: Copy>(numbers: &[Number], each: usize, missing: [T; 4], convert: impl Fn(&Number) -> T) -> Vec<[T; 4]> {
    numbers
        .chunks(each)
        .map(|texel| {
            let mut rgba = missing;
            for (channel, number) in rgba.iter_mut().zip(texel) {
                *channel = convert(number);
            }
            rgba
        })
        .collect()
}

/// The bytes of an image: a file, or one inside of a glTF file, by its number.
fn load_file(loader: &mut Loader<'_>, table: &DeTable<'_>, name: &str, span: Span) -> Option<(String, Vec<u8>)> {
    let (path, bytes) = loader.bytes(name, span)?;
    let Some(node) = table.get("image") else { return Some((path, bytes)) };
    let number = loader.reader.integer(node, "image", 0..=i64::from(u32::MAX))? as u32;
    match gltf_image(&path, &bytes, number, loader.files) {
        Ok(image) => Some((format!("{path}, image {number}"), image)),
        Err(error) => {
            let span = loader.reader.span_of(node);
            loader.reader.error(&SCENE_BAD_ASSET, span, format!("`{path}`: {error}"), "no image of a glTF file");
            None
        }
    }
}

/// Loads an image file as a level: 8 or 16 bits per channel become numbers in [0, 1], decoded if asked. The bottom row
/// is at t = 0, so that the image is upright, unless `flip = false`.
fn load_image(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    file: &Node<'_>,
    name: &str,
    kind: SamplerType,
) -> Option<TextureLevel> {
    let span = loader.reader.span_of(file);
    let path = loader.reader.text(file, "file")?.to_owned();
    let flip = loader.reader.flag(table, "flip", true);
    let decode = loader.reader.choice_at(table, "decode", Transfer::Linear, Transfer::NAMES);
    if !matches!(kind.dim, SamplerDim::D1 | SamplerDim::D2 | SamplerDim::Rect)
        || kind.arrayed
        || kind.texel != Scalar::Float
    {
        let message = format!("`{name}` is a {}: an image file can only be read as 2D of floats", kind.name());
        loader.reader.error(&SCENE_WRONG_KIND, span, message, "not for this sampler");
        return None;
    }
    let (path, bytes) = load_file(loader, table, &path, span)?;
    // A side that no sampler may have is told with the sampler's name, below.
    let image = match Image::read(&bytes, u32::MAX, MAX_TEXELS) {
        Ok(image) => image,
        Err(error) => {
            let message = format!("`{path}` is not an image that can be read: {error}");
            loader.reader.error(&SCENE_BAD_ASSET, span, message, "");
            return None;
        }
    };
    let image = if flip { image.flipped() } else { image };
    let Image { width, height, pixels } = image;
    let light = |[red, green, blue, alpha]: [f32; 4]| {
        let [red, green, blue] = [red, green, blue].map(|channel| decode.decode(f64::from(channel)) as f32);
        [red, green, blue, alpha]
    };
    if width > MAX_SIDE || height > MAX_SIDE || (kind.dim == SamplerDim::D1 && height > 1) {
        let most = if kind.dim == SamplerDim::D1 { 1 } else { MAX_SIDE };
        let message = format!("`{path}` has {width}x{height} texels, and a {} at most {MAX_SIDE}x{most}", kind.name());
        loader.reader.error(&SCENE_WRONG_SIZE, span, message, "too large");
        return None;
    }
    let pixels = if decode == Transfer::Linear { pixels } else { pixels.into_iter().map(light).collect() };
    Some(TextureLevel { width, height, depth: 1, texels: Texels::Float(pixels) })
}
