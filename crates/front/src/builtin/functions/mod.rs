//! The built-in functions (GLSL 1.50 §8) as a table, with one [`Row`] for each overload of the specification.
//!
//! *In:* a name. *Out:* its rows, and for each row the concrete [`Signature`]s of its placeholders (`genType`, `mat`,
//! `gsampler2D`). *Holds:* all placeholders of a row vary together, so a row has one list of signatures. *Not done
//! here:* overload resolution (`analysis`), and the computation of a function, which
//! [`operations`](super::operations) defines by the [`BuiltinFunction`] of the row.

mod bits;
mod common;
mod geometric;
mod matcher;
mod texture;
mod texture_cube_array;
mod texture_extensions;
mod texture_gather;
mod texture_old;

pub use matcher::Matcher;

use super::operations::Operation;
use super::{Availability, BuiltinFunction};
use crate::language::{ParamMode, Stage, TypeId, Types};
use rustc_hash::FxHashMap;
use std::sync::OnceLock;

/// The effect of a call besides its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Nothing.
    None,
    /// It writes an argument (`modf`).
    WritesArgument,
    /// It reads from neighboring fragments (§8.8).
    Derivative,
    /// It reads a texture, whose level of detail may depend on the neighboring fragments (§8.7).
    Texture,
    /// It emits a vertex or ends a primitive (§8.10).
    Emits,
}

/// A parameter of a [`Row`].
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name in the specification.
    pub name: &'static str,
    /// The types that it accepts.
    pub matcher: Matcher,
}

/// An overload, as the specification prints it.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The identity of the function.
    pub function: BuiltinFunction,
    /// The name in GLSL. Older names of a computation have separate rows.
    pub name: &'static str,
    /// The result type.
    pub ret: Matcher,
    /// The parameters.
    pub params: &'static [Parameter],
    /// The languages and stages in which it exists.
    pub availability: Availability,
    /// The section of GLSL 1.50.
    pub section: &'static str,
    /// Whether it is allowed in a constant expression (§4.3.3).
    pub constant: bool,
    /// Its effect besides the result.
    pub effect: Effect,
    /// Whether the specification calls it deprecated.
    pub deprecated: bool,
}

impl Operation {
    /// The prototypes, in the order of the specification.
    pub fn prototypes(&self) -> impl Iterator<Item = &'static Row> + use<> {
        let function = self.function;
        all().filter(move |row| row.function == function)
    }

    /// The section of GLSL 1.50.
    pub fn section(&self) -> &'static str {
        self.prototypes().next().map_or("", |row| row.section)
    }
}

/// The largest number of parameters of a built-in function.
pub const MAX_PARAMS: usize = 5;

/// A concrete overload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signature {
    params: [(TypeId, ParamMode); MAX_PARAMS],
    n_params: u8,
    /// The type of the result.
    pub ret: TypeId,
}

impl Signature {
    /// Whether the parameters have these types.
    pub fn has_types(&self, types: &[TypeId]) -> bool {
        self.params().iter().map(|(ty, _)| ty).eq(types)
    }

    /// The types and modes of the parameters.
    pub fn params(&self) -> &[(TypeId, ParamMode)] {
        self.params.get(..usize::from(self.n_params)).unwrap_or(&[])
    }
}

impl Row {
    /// The default columns of a row.
    const fn base(section: &'static str, version: u16) -> Self {
        Self {
            function: BuiltinFunction::Radians,
            name: "",
            ret: matcher::void,
            params: &[],
            availability: Availability::since(version),
            section,
            constant: true,
            effect: Effect::None,
            deprecated: false,
        }
    }

    const fn with(self, effect: Effect, constant: bool) -> Self {
        Self { effect, constant, ..self }
    }

    const fn available(self, availability: Availability) -> Self {
        Self { availability, ..self }
    }

    /// The concrete overloads in a stage. Iterating allocates nothing. In fragment shaders, the optional `bias`
    /// yields each of them a second time.
    pub fn signatures(&'static self, stage: Stage) -> impl Iterator<Item = Signature> {
        let optional = self.params.last().is_some_and(|param| param.matcher == Matcher::OptionalBias);
        let n_required = self.params.len() - usize::from(optional);
        let n_all = if optional && stage == Stage::Fragment { n_required + 1 } else { n_required };
        (n_required..=n_all)
            .flat_map(move |n_params| (0..self.n_types()).map(move |choice| self.signature(choice, n_params)))
    }

    /// The number of types of the placeholders.
    fn n_types(&self) -> u8 {
        let params = self.params.iter().map(|param| param.matcher);
        params.chain([self.ret]).map(Matcher::n_types).max().unwrap_or(1)
    }

    fn signature(&self, choice: u8, n_params: usize) -> Signature {
        let mut params = [(TypeId::VOID, ParamMode::In); MAX_PARAMS];
        for (slot, param) in params.iter_mut().zip(self.params).take(n_params) {
            *slot = (param.matcher.choose(choice), param.matcher.mode());
        }
        Signature { params, n_params: n_params as u8, ret: self.ret.choose(choice) }
    }

    /// The prototype as the specification prints it: `gvec4 texture(gsampler2D sampler, vec2 P [, float bias])`.
    pub fn prototype(&self) -> String {
        let mut text = format!("{} {}(", self.ret.spelling(), self.name);
        for (index, param) in self.params.iter().enumerate() {
            let (open, close) = if param.matcher == Matcher::OptionalBias { (" [", "]") } else { ("", "") };
            let comma = if index > 0 { ", " } else { "" };
            let comma = if open.is_empty() { comma } else { comma.trim_end() };
            let gap = if open.is_empty() { "" } else { " " };
            text.push_str(&format!("{open}{comma}{gap}{} {}{close}", param.matcher.spelling(), param.name));
        }
        text.push(')');
        text
    }
}

impl Signature {
    /// The overload as a declaration: `vec4 texture(sampler2D, vec2)`.
    pub fn describe(&self, name: &str, types: &Types) -> String {
        let params: Vec<String> = self
            .params()
            .iter()
            .map(|&(ty, mode)| {
                let out = if mode == ParamMode::Out { "out " } else { "" };
                format!("{out}{}", types.name(ty))
            })
            .collect();
        format!("{} {name}({})", types.name(self.ret), params.join(", "))
    }
}

/// Converts lines in the style of the specification to [`Row`]s: `BASE Identity: genType sin(genType angle);`, where
/// the base is a constant row that contains all other columns.
macro_rules! rows {
    ($($base:ident $function:ident: $ret:ident $name:ident($($ty:ident $param:ident),*);)*) => {
        &[$(Row {
            function: BuiltinFunction::$function,
            name: stringify!($name),
            ret: matcher::$ret,
            params: &[$(Parameter { name: stringify!($param), matcher: matcher::$ty }),*],
            ..$base
        }),*]
    };
}
use rows;

static TABLES: &[&[Row]] = &[
    common::ROWS,
    bits::ROWS,
    geometric::ROWS,
    texture::ROWS,
    texture_old::ROWS,
    texture_extensions::ROWS,
    texture_cube_array::ROWS,
    texture_gather::ROWS,
];

/// All rows, in the order of the specification's sections.
pub fn all() -> impl Iterator<Item = &'static Row> {
    TABLES.iter().flat_map(|table| table.iter())
}

/// All rows, sorted by name. Rows with one name keep the specification's order.
fn by_name() -> &'static [&'static Row] {
    static SORTED: OnceLock<Vec<&'static Row>> = OnceLock::new();
    SORTED.get_or_init(|| {
        let mut rows: Vec<&'static Row> = all().collect();
        rows.sort_by_key(|row| row.name);
        rows
    })
}

/// The rows with a name, in any version and stage; none if no version has the name.
pub fn named(name: &str) -> &'static [&'static Row] {
    static INDEX: OnceLock<FxHashMap<&'static str, &'static [&'static Row]>> = OnceLock::new();
    let groups = || by_name().chunk_by(|a, b| a.name == b.name).filter_map(|rows| Some((rows.first()?.name, rows)));
    INDEX.get_or_init(|| groups().collect()).get(name).copied().unwrap_or(&[])
}

/// Whether a compiler for Vulkan knows a function with this name: one of the language, or of AMD_shader_trinary_minmax, which
/// glslang has built in. It takes no other function of that name, since it could not have the precisions of the built-in one.
pub fn is_known_for_vulkan(name: &str) -> bool {
    !named(name).is_empty()
}

/// Every name once, in sorted order.
pub fn names() -> impl Iterator<Item = &'static str> {
    by_name().chunk_by(|a, b| a.name == b.name).filter_map(|rows| rows.first().map(|row| row.name))
}

#[cfg(test)]
mod tests;
