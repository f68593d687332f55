//! Assigns locations to varyings: outputs of the stage before the rasterizer and inputs of the fragment stage, split
//! into scalars and vectors (columns of matrices, elements of arrays, members of structs and blocks).
//!
//! If both stages are there, a varying is what both declare. An output that the fragment stage does not declare is
//! not a varying; nor is an input without an output (nothing reads it, or the link failed). Varyings that are read
//! come first. Each takes a location of its own while there are enough; after that, scalars and vectors of equal type
//! and interpolation share locations. Explicit locations are kept. Clip distances that the fragment stage reads come
//! last, but before varyings that nothing reads if space is short.

use super::clip_distances::ClipDistances;
use super::compatible::{block_parts, same_type};
use super::flatten::{join, parts};
use super::locations::Locations;
use super::matching::Outputs;
use super::{Linker, Varying, VaryingEnd};
use crate::diagnostic::{Diagnostic, codes, plural};
use crate::hir::{
    ArraySize, Global, GlobalId, Interpolation, MatrixLayout, Sampling, Scalar, Shader, Stage, Storage, Type, TypeId,
    Types,
};
use crate::source::Span;

/// The number of varying locations that every WebGPU implementation has.
const PORTABLE_LOCATIONS: u32 = 16;
/// The largest number that an implementation offers (gl_MaxFragmentInputComponents is 128).
const MAX_LOCATIONS: u32 = 32;

/// A whole variable with both its ends.
struct Whole<'a> {
    from: Option<(GlobalId, &'a Global)>,
    to: Option<(GlobalId, &'a Global)>,
}

impl<'a> Whole<'a> {
    /// The end that determines the interpolation: the fragment stage's, if it is there.
    fn decisive(&self) -> Option<&'a Global> {
        self.to.or(self.from).map(|(_, global)| global)
    }

    fn active(&self) -> bool {
        match (self.to, self.from) {
            (Some((_, input)), _) => input.used,
            (None, Some((_, output))) => output.written,
            (None, None) => false,
        }
    }
}

/// All varyings of a program in order of location, and the interpolated clip distances.
pub(super) fn assign(ctx: &mut Linker<'_>, stages: &[Shader]) -> (Vec<Varying>, Vec<Varying>) {
    let of = |stage: Stage| stages.iter().find(|shader| shader.stage == stage);
    let (producer, fragment) = (of(Stage::Geometry).or(of(Stage::Vertex)), of(Stage::Fragment));
    if stages.len() > 1 {
        stages.iter().for_each(|shader| check_places(ctx, shader));
    }
    let mut wholes = wholes(ctx.types, producer, fragment);
    wholes.sort_by_key(|whole| !whole.active());
    let mut pieces = Vec::new();
    for whole in &wholes {
        if !fits(ctx, whole) {
            return Default::default();
        }
        cut(ctx.types, whole, &mut pieces);
    }
    let clip = ClipDistances::find(ctx.types, producer, fragment);
    warn_above_minimum(ctx, &wholes, &pieces, clip.as_ref());
    place(ctx, pieces, clip.as_ref())
}

/// Reports explicit places that overlap in one stage, those of variables that the other stage does not declare included. A stage that
/// is alone is checked where its varyings are placed.
fn check_places(ctx: &mut Linker<'_>, shader: &Shader) {
    for storage in [Storage::In, Storage::Out] {
        // Attributes and colors have rules of their own.
        let is_outer =
            matches!((shader.stage, storage), (Stage::Vertex, Storage::In) | (Stage::Fragment, Storage::Out));
        let ends = shader.globals().filter(|(_, global)| {
            !is_outer && global.storage == storage && global.builtin.is_none() && has_place(ctx.types, global)
        });
        let mut pieces = Vec::new();
        for (id, global) in ends {
            let of_vertex = Global { ty: one_vertex(ctx.types, shader.stage, storage, global.ty), ..global.clone() };
            if ctx.types.flat_len(of_vertex.ty) <= MAX_LOCATIONS * 4 {
                cut(ctx.types, &Whole { from: Some((id, &of_vertex)), to: None }, &mut pieces);
            }
        }
        put_fixed(ctx, &mut Room::new(false), pieces.into_iter().filter(|piece| piece.fixed.is_some()));
    }
}

/// Whether a variable, or a member of a block, has an explicit location.
fn has_place(types: &Types, global: &Global) -> bool {
    let of_member = || {
        let parts = global.block.as_ref().and_then(|_| block_parts(types, global.ty));
        parts.is_some_and(|(id, _)| types.structure(id).members.iter().any(|member| member.place.location.is_some()))
    };
    global.location.is_some() || of_member()
}

/// The type for one vertex: a geometry stage declares an array of it.
fn one_vertex(types: &Types, stage: Stage, storage: Storage, ty: TypeId) -> TypeId {
    let is_array = stage == Stage::Geometry && storage == Storage::In;
    types.element(ty).filter(|_| is_array).unwrap_or(ty)
}

fn wholes<'a>(types: &Types, producer: Option<&'a Shader>, fragment: Option<&'a Shader>) -> Vec<Whole<'a>> {
    let ends = |shader: &'a Shader, storage: Storage| {
        shader.globals().filter(move |(_, global)| global.storage == storage && global.builtin.is_none())
    };
    match (producer, fragment) {
        (Some(producer), Some(fragment)) => {
            let outputs = Outputs::new(producer);
            ends(fragment, Storage::In)
                .filter_map(|to| {
                    let from = outputs.partner(to.1).filter(|(_, output)| same_type_or_block(types, output, to.1))?;
                    Some(Whole { from: Some(from), to: Some(to) })
                })
                .collect()
        }
        (Some(producer), None) => {
            ends(producer, Storage::Out).map(|from| Whole { from: Some(from), to: None }).collect()
        }
        (None, Some(fragment)) => ends(fragment, Storage::In).map(|to| Whole { from: None, to: Some(to) }).collect(),
        (None, None) => Vec::new(),
    }
}

/// Whether the types are the same or both are blocks. Blocks were compared member by member, with any mismatch
/// reported.
fn same_type_or_block(types: &Types, output: &Global, input: &Global) -> bool {
    types.flat_len(output.ty) == types.flat_len(input.ty)
        && (input.block.is_some() || same_type(types, output.ty, input.ty))
}

/// Whether a variable alone is within the limits, so that an absurdly large array is not split.
fn fits(ctx: &mut Linker<'_>, whole: &Whole<'_>) -> bool {
    let Some(global) = whole.decisive() else { return true };
    let components = ctx.types.flat_len(global.ty);
    if components <= MAX_LOCATIONS * 4 {
        return true;
    }
    let message = format!(
        "`{}` has {components} components, and varyings have at most {}",
        global.match_name(),
        MAX_LOCATIONS * 4
    );
    ctx.report(Diagnostic::new(&codes::link::TOO_MANY_VARYINGS, global.span, message));
    false
}

/// A scalar or vector without a location.
struct Piece {
    varying: Varying,
    /// The explicit location and component, if there are.
    fixed: Option<(u32, u32)>,
    scalar: Scalar,
    size: u8,
    span: Span,
}

fn cut(types: &Types, whole: &Whole<'_>, pieces: &mut Vec<Piece>) {
    let Some(global) = whole.decisive() else { return };
    let place = |global: &Global| Some((global.location?, global.component.unwrap_or(0)));
    let explicit = whole.to.and_then(|(_, input)| place(input)).or(whole.from.and_then(|(_, output)| place(output)));
    let mut fixed = explicit;
    for member in members(types, global) {
        fixed = member.place.or(fixed);
        for part in parts(types, &member.name, member.ty, MatrixLayout::ColumnMajor) {
            for (name, ty, offset) in vectors(types, &part.name, part.ty) {
                let Some(scalar) = types.scalar_of(ty) else { continue };
                let flat_offset = member.flat_offset + part.flat_offset + offset;
                let end = |end: Option<(GlobalId, &Global)>| end.map(|(global, _)| VaryingEnd { global, flat_offset });
                let varying = Varying {
                    name,
                    ty,
                    location: 0,
                    component: 0,
                    interpolation: if scalar.is_integer() { Interpolation::Flat } else { member.interpolation },
                    sampling: member.sampling,
                    active: whole.active(),
                    from: end(whole.from),
                    to: end(whole.to),
                };
                let size = types.flat_len(ty) as u8;
                pieces.push(Piece { varying, fixed, scalar, size, span: global.span });
                fixed = fixed.map(|(location, component)| (location.saturating_add(1), component));
            }
        }
    }
}

struct QualifiedMember {
    name: String,
    ty: TypeId,
    flat_offset: u32,
    interpolation: Interpolation,
    sampling: Sampling,
    /// The member's own location and component.
    place: Option<(u32, u32)>,
}

/// The variable itself, or the members of a block (of each element of an array of blocks), each with its own
/// qualifiers.
fn members(types: &Types, global: &Global) -> Vec<QualifiedMember> {
    let Some(block) = &global.block else {
        let Global { name, ty, interpolation, sampling, .. } = global;
        return vec![QualifiedMember {
            name: name.clone(),
            ty: *ty,
            flat_offset: 0,
            interpolation: *interpolation,
            sampling: *sampling,
            place: None,
        }];
    };
    let (element, count) = match types.get(global.ty) {
        Type::Array(element, ArraySize::Sized(count)) => (element, Some(count)),
        _ => (global.ty, None),
    };
    let Type::Struct(id) = types.get(element) else { return Vec::new() };
    let mut list = Vec::new();
    let mut flat_offset = 0;
    for index in 0..count.unwrap_or(1) {
        let prefix = match (block.instance.is_some(), count) {
            (false, _) => String::new(),
            (true, None) => block.name.clone(),
            (true, Some(_)) => format!("{}[{index}]", block.name),
        };
        for member in &types.structure(id).members {
            list.push(QualifiedMember {
                name: join(&prefix, &member.name),
                ty: member.ty,
                flat_offset,
                interpolation: member.interpolation.unwrap_or(global.interpolation),
                sampling: if member.sampling == Sampling::Center { global.sampling } else { member.sampling },
                place: member.place.location.map(|location| (location, member.place.component.unwrap_or(0))),
            });
            flat_offset += types.flat_len(member.ty);
        }
    }
    list
}

/// The scalars and vectors of a scalar, vector, matrix or array of those, with the offset of each in scalars.
fn vectors(types: &Types, name: &str, ty: TypeId) -> Vec<(String, TypeId, u32)> {
    let indexed = |count: u32, element: TypeId| {
        let stride = types.flat_len(element);
        (0..count).map(move |index| (format!("{name}[{index}]"), element, index * stride))
    };
    match types.get(ty) {
        Type::Matrix(columns, rows) => indexed(u32::from(columns), TypeId::vector(Scalar::Float, rows)).collect(),
        Type::Array(element, ArraySize::Sized(count)) => indexed(count, element)
            .flat_map(|(name, ty, offset)| {
                let inner = vectors(types, &name, ty).into_iter();
                inner.map(move |(name, ty, inner)| (name, ty, offset + inner)).collect::<Vec<_>>()
            })
            .collect(),
        Type::Scalar(_) | Type::Vector(..) => vec![(name.to_owned(), ty, 0)],
        Type::Error | Type::Void | Type::Sampler(_) | Type::Struct(_) | Type::Array(..) => Vec::new(),
    }
}

fn warn_above_minimum(ctx: &mut Linker<'_>, wholes: &[Whole<'_>], pieces: &[Piece], clip: Option<&ClipDistances<'_>>) {
    const MINIMUM: u32 = 60;
    let components: u32 = pieces.iter().filter(|piece| piece.varying.active).map(|piece| u32::from(piece.size)).sum();
    let components = components + clip.map_or(0, ClipDistances::components);
    if components > MINIMUM {
        let span =
            wholes.iter().rev().filter(|whole| whole.active()).find_map(Whole::decisive).map(|global| global.span);
        let message =
            format!("the varyings have {components} components, and gl_MaxVaryingComponents may be {MINIMUM}");
        ctx.report(Diagnostic::new(&codes::link::VARYINGS_ABOVE_MINIMUM, span.unwrap_or_default(), message));
    }
}

/// Assigns locations to all pieces, then to the clip distances. Inactive pieces that do not fit are dropped.
fn place(ctx: &mut Linker<'_>, pieces: Vec<Piece>, clip: Option<&ClipDistances<'_>>) -> (Vec<Varying>, Vec<Varying>) {
    let n_clip = clip.map_or(0, ClipDistances::locations);
    let mut room = Room::new(pieces.len() as u32 + n_clip > PORTABLE_LOCATIONS);
    let (fixed, mut free): (Vec<Piece>, Vec<Piece>) = pieces.into_iter().partition(|piece| piece.fixed.is_some());
    let mut placed = put_fixed(ctx, &mut room, fixed.into_iter());
    if room.shared {
        // Large ones first, so that small ones fill the gaps.
        free.sort_by_key(|piece| (!piece.varying.active, 4 - piece.size));
    }
    let mut reported = false;
    for piece in free {
        let active = piece.varying.active;
        match room.put(&piece, if active { 0 } else { n_clip }) {
            Some((location, component)) => placed.push(at(piece, location, component)),
            None if active && !reported => {
                reported = true;
                no_room(ctx, &piece);
            }
            None => {}
        }
    }
    placed.sort_by_key(|varying| (varying.location, varying.component));
    let clip_distances = clip.filter(|_| !reported).and_then(|clip| {
        let first = room.last(n_clip);
        if first.is_none() {
            ctx.report(clip.no_room(MAX_LOCATIONS));
        }
        Some(clip.at(first?))
    });
    (placed, clip_distances.unwrap_or_default())
}

/// Puts pieces at their explicit places, and reports those that have none there.
fn put_fixed(ctx: &mut Linker<'_>, room: &mut Room, pieces: impl Iterator<Item = Piece>) -> Vec<Varying> {
    let mut placed = Vec::new();
    for piece in pieces {
        let (location, component) = piece.fixed.unwrap_or_default();
        match room.put_at(&piece, location, component) {
            Ok(()) => placed.push(at(piece, location, component)),
            Err(Taken::Beyond) => no_room(ctx, &piece),
            Err(Taken::Shared) => overlap(ctx, &piece, &placed),
        }
    }
    placed
}

/// Reports an explicit location that another varying has, at least in part, or whose other varyings differ in kind: "the
/// same underlying numerical type, the same interpolation" (4.40 §4.4.1).
fn overlap(ctx: &mut Linker<'_>, piece: &Piece, placed: &[Varying]) {
    let (location, component) = piece.fixed.unwrap_or_default();
    let name = &piece.varying.name;
    let other = placed.iter().find(|other| other.location == location);
    let message = match other {
        Some(other) => format!("`{name}` and `{}` cannot share location {location}", other.name),
        None => format!("`{name}` cannot have location {location}"),
    };
    let here = format!("from component {component} on, as another of equal kind could");
    ctx.report(
        Diagnostic::new(&codes::link::VARYING_OVERLAP, piece.span, message)
            .here(here)
            .help("give it another `location`, or both a `component` that the other leaves free"),
    );
}

fn at(piece: Piece, location: u32, component: u32) -> Varying {
    Varying { location, component, ..piece.varying }
}

fn no_room(ctx: &mut Linker<'_>, piece: &Piece) {
    let message =
        format!("no room for the varying `{}`: there are {}", piece.varying.name, plural(MAX_LOCATIONS, "location"));
    ctx.report(Diagnostic::new(&codes::link::TOO_MANY_VARYINGS, piece.span, message));
}

/// The contents of a location: how many components are in use, and the kind of its varyings.
#[derive(Clone, Copy, Default)]
struct LocationContents {
    used: u8,
    /// A bit for each component that has an explicit place.
    taken: u8,
    kind: Option<(Scalar, Interpolation, Sampling)>,
}

impl LocationContents {
    fn is_free(&self) -> bool {
        self.kind.is_none()
    }

    fn fill(&mut self, piece: &Piece, used: u8) {
        self.used = used;
        self.kind = Some(kind(piece));
    }
}

fn kind(piece: &Piece) -> (Scalar, Interpolation, Sampling) {
    (piece.scalar, piece.varying.interpolation, piece.varying.sampling)
}

/// Why an explicit place cannot be had.
enum Taken {
    /// There are fewer locations.
    Beyond,
    /// Another varying has it.
    Shared,
}

/// The locations of varyings, and whether several varyings of one kind share a location.
struct Room {
    slots: Locations<LocationContents>,
    shared: bool,
}

impl Room {
    fn new(shared: bool) -> Self {
        Self { slots: Locations::new(MAX_LOCATIONS), shared }
    }

    /// Takes components of an explicit location. No other varying is put there by itself.
    fn put_at(&mut self, piece: &Piece, location: u32, component: u32) -> Result<(), Taken> {
        let slot = self.slots.run_mut(location, 1).and_then(|slots| slots.first_mut()).ok_or(Taken::Beyond)?;
        let bits = ((1u32 << piece.size.min(4)) - 1).checked_shl(component).unwrap_or(u32::MAX);
        let bits = u8::try_from(bits).ok().filter(|bits| *bits < 16).ok_or(Taken::Shared)?;
        if slot.taken & bits != 0 || slot.kind.is_some_and(|known| known != kind(piece)) {
            return Err(Taken::Shared);
        }
        slot.taken |= bits;
        slot.fill(piece, 4);
        Ok(())
    }

    /// Finds a location and its first free component, if `keep` consecutive locations stay free.
    fn put(&mut self, piece: &Piece, keep: u32) -> Option<(u32, u32)> {
        let fitting = |slot: &LocationContents| match slot.kind {
            None => true,
            Some(kept) => self.shared && kept == kind(piece) && slot.used + piece.size <= 4,
        };
        let location = self.slots.lowest(1, fitting)?;
        let mut slots = self.slots.clone();
        let slot = slots.run_mut(location, 1)?.first_mut()?;
        let component = u32::from(slot.used);
        slot.fill(piece, slot.used + piece.size);
        slots.lowest(keep, LocationContents::is_free)?;
        self.slots = slots;
        Some((location, component))
    }

    /// The first of `count` locations above all others.
    fn last(&self, count: u32) -> Option<u32> {
        self.slots.above_all(count, LocationContents::is_free)
    }
}
