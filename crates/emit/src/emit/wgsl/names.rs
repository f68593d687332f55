//! The names of a module, and its types in WGSL.
//!
//! naga makes names unique in the whole module and appends an underscore to names that end in a digit. WGSL has scopes
//! (WGSL §7.1): here, names of the module differ from each other and from words of the language; members of structs only
//! from each other; locals from what their function uses ([`super::scopes`]).

use super::tree::Expr;
use naga::common::wgsl::TypeContext;
use naga::keywords::wgsl::{BUILTIN_IDENTIFIERS, RESERVED};
use naga::{Constant, Function, GlobalVariable, Handle, Module, Type, TypeInner};
use rustc_hash::{FxHashMap, FxHashSet};
use std::borrow::Cow;
use std::fmt::Write;
use std::sync::LazyLock;

/// The words that no name may be: keywords, reserved words, and the names of types and functions.
static WORDS: LazyLock<FxHashSet<&'static str>> =
    LazyLock::new(|| RESERVED.iter().chain(BUILTIN_IDENTIFIERS).copied().collect());

/// Whether WGSL has a meaning for a word.
pub(super) fn is_word(name: &str) -> bool {
    WORDS.contains(name)
}

/// The names of everything in a module but locals.
pub(super) struct Names {
    types: FxHashMap<Handle<Type>, String>,
    members: FxHashMap<Handle<Type>, Vec<String>>,
    constants: Vec<Option<String>>,
    globals: Vec<String>,
    functions: Vec<String>,
    entries: Vec<String>,
}

/// Names that are taken.
#[derive(Default)]
struct Taken {
    names: FxHashSet<String>,
    last: FxHashMap<String, u32>,
}

impl Taken {
    /// A name that is not taken yet, close to the one of the source.
    fn take(&mut self, wanted: Option<&String>, otherwise: &str) -> String {
        let base = plain(wanted.map_or(otherwise, String::as_str));
        let number = self.last.entry(base.clone()).or_default();
        loop {
            let name = if *number == 0 { base.clone() } else { format!("{base}_{number}") };
            *number += 1;
            if !is_word(&name) && self.names.insert(name.clone()) {
                return name;
            }
        }
    }
}

/// An identifier of WGSL (§3.8): not `_`, and without two underscores in front.
pub(super) fn plain(name: &str) -> String {
    let valid = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let text: String = name.chars().map(|c| if valid(c) { c } else { '_' }).collect();
    let bare = text.trim_start_matches('_');
    match bare.chars().next() {
        None => "unnamed".to_owned(),
        Some(first) if first.is_ascii_digit() => format!("n{bare}"),
        Some(_) if text.starts_with("__") => format!("_{bare}"),
        Some(_) => text,
    }
}

impl Names {
    /// The names of a module, without those that its text has for functions of its own.
    pub(super) fn of(module: &Module, reserved: impl Iterator<Item = &'static str>) -> Self {
        let mut taken = Taken { names: reserved.map(str::to_owned).collect(), ..Taken::default() };
        let mut names = Self {
            types: FxHashMap::default(),
            members: FxHashMap::default(),
            constants: Vec::new(),
            globals: Vec::new(),
            functions: Vec::new(),
            entries: Vec::new(),
        };
        for entry in &module.entry_points {
            names.entries.push(taken.take(Some(&entry.name), "main"));
        }
        for (handle, ty) in module.types.iter() {
            let TypeInner::Struct { members, .. } = &ty.inner else { continue };
            names.types.insert(handle, taken.take(ty.name.as_ref(), "Struct"));
            let mut own = Taken::default();
            let members = members.iter().map(|member| own.member(member.name.as_ref()));
            names.members.insert(handle, members.collect());
        }
        for (_, constant) in module.constants.iter() {
            names.constants.push(constant.name.as_ref().map(|name| taken.take(Some(name), "constant")));
        }
        for (_, variable) in module.global_variables.iter() {
            names.globals.push(taken.take(variable.name.as_ref(), "global"));
        }
        for (_, function) in module.functions.iter() {
            names.functions.push(taken.take(function.name.as_ref(), "function"));
        }
        names
    }

    pub(super) fn function(&self, handle: Handle<Function>) -> &str {
        self.functions.get(handle.index()).map_or("", String::as_str)
    }

    pub(super) fn entry(&self, index: usize) -> &str {
        self.entries.get(index).map_or("main", String::as_str)
    }

    pub(super) fn global_name(&self, handle: Handle<GlobalVariable>) -> &str {
        self.globals.get(handle.index()).map_or("", String::as_str)
    }

    pub(super) fn constant_name(&self, handle: Handle<Constant>) -> Option<&str> {
        self.constants.get(handle.index())?.as_deref()
    }

    pub(super) fn member_name(&self, ty: Handle<Type>, index: u32) -> &str {
        self.members.get(&ty).and_then(|members| members.get(index as usize)).map_or("", String::as_str)
    }

    /// A type as declarations have it.
    pub(super) fn ty(&self, module: &Module, ty: Handle<Type>) -> String {
        let mut text = String::new();
        // Writing to a string does not fail.
        let _ = Types { names: self, module }.write_type(ty, &mut text);
        text
    }

    /// A type without a handle.
    pub(super) fn inner(&self, module: &Module, inner: &TypeInner) -> String {
        let mut text = String::new();
        let _ = Types { names: self, module }.write_type_inner(inner, &mut text);
        text
    }
}

impl Taken {
    /// The name of a member, which may be anything but a keyword.
    fn member(&mut self, wanted: Option<&String>) -> String {
        let base = plain(wanted.map_or("member", String::as_str));
        let mut number = 0;
        loop {
            let name = if number == 0 { base.clone() } else { format!("{base}_{number}") };
            number += 1;
            if !RESERVED.contains(&name.as_str()) && self.names.insert(name.clone()) {
                return name;
            }
        }
    }
}

/// The names of a module as expressions.
#[derive(Clone, Copy)]
pub(super) struct Words<'m>(pub(super) &'m Names);

impl<'m> Words<'m> {
    pub(super) fn global(self, handle: Handle<GlobalVariable>) -> Expr<'m> {
        Expr::Leaf(self.0.global_name(handle).into())
    }

    pub(super) fn constant(self, handle: Handle<Constant>) -> Expr<'m> {
        Expr::Constant(self.0.constant_name(handle).unwrap_or("").into())
    }

    pub(super) fn member(self, ty: Handle<Type>, index: u32) -> Cow<'m, str> {
        self.0.member_name(ty, index).into()
    }

    pub(super) fn ty(self, module: &Module, ty: Handle<Type>) -> String {
        self.0.ty(module, ty)
    }

    pub(super) fn inner(self, module: &Module, inner: &TypeInner) -> String {
        self.0.inner(module, inner)
    }
}

/// A vector's constructor, which takes its components' type from them.
pub(super) fn short_type(inner: &TypeInner) -> &'static str {
    match inner {
        TypeInner::Vector { size: naga::VectorSize::Bi, .. } => "vec2",
        TypeInner::Vector { size: naga::VectorSize::Tri, .. } => "vec3",
        _ => "vec4",
    }
}

/// Types with the names of a module.
struct Types<'m> {
    names: &'m Names,
    module: &'m Module,
}

impl TypeContext for Types<'_> {
    fn lookup_type(&self, handle: Handle<Type>) -> &Type {
        &self.module.types[handle]
    }

    fn type_name(&self, handle: Handle<Type>) -> &str {
        self.names.types.get(&handle).map_or("", String::as_str)
    }

    fn write_override<W: Write>(&self, _: Handle<naga::Override>, _: &mut W) -> std::fmt::Result {
        Err(std::fmt::Error)
    }

    fn write_unnamed_struct<W: Write>(&self, _: &TypeInner, _: &mut W) -> std::fmt::Result {
        Err(std::fmt::Error)
    }

    fn write_non_wgsl_inner<W: Write>(&self, _: &TypeInner, _: &mut W) -> std::fmt::Result {
        Err(std::fmt::Error)
    }

    fn write_non_wgsl_scalar<W: Write>(&self, _: naga::Scalar, _: &mut W) -> std::fmt::Result {
        Err(std::fmt::Error)
    }
}
