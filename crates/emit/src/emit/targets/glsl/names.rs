//! Names that are words of a later version (GLSL 4.50 §3.6, GLSL ES 3.00 §3.7): they get an underscore.
//!
//! *In:* a program. *Out:* for each such name its new one. *Holds:* the new name depends on the program and the
//! version alone, so the stages agree, and the reflection can tell it.

use crate::target::GlslVersion;
use glisten_front::builtin::functions;
use glisten_front::builtin::operations::Class;
use glisten_front::hir::{ExprKind, Shader, StructId, Type, TypeId, Types};
use glisten_front::link::Program;
use glisten_front::source::Span;
use glisten_front::syntax::keywords;
use std::collections::{BTreeMap, BTreeSet};

/// Whether a name of a program is a word of a version.
fn is_word(name: &str, version: GlslVersion) -> bool {
    keywords::is_taken(name, super::language(version, Span::default()))
        || version == GlslVersion::Vulkan && keywords::is_of_vulkan(name)
}

/// The new names of a program, by the old ones.
pub(in crate::emit) fn renamed(program: &Program, version: GlslVersion) -> BTreeMap<String, String> {
    let mut all: BTreeSet<&str> = BTreeSet::new();
    let mut global: BTreeSet<&str> = BTreeSet::new();
    for shader in &program.stages {
        collect(&program.types, shader, &mut all, &mut global);
    }
    let called: BTreeSet<&str> = program.stages.iter().flat_map(texture_functions).collect();
    let hidden = hidden(program, &global, version);
    let mut names = BTreeMap::new();
    for &name in &all {
        let reserved = is_word(name, version);
        // GLSL ES 3.00 §6.1: built-in functions cannot be redefined. Global names share their scope.
        let redefines = global.contains(name)
            && match version {
                GlslVersion::Es300 => !functions::named(name).is_empty(),
                GlslVersion::Vulkan => functions::is_known_for_vulkan(name),
                GlslVersion::Desktop330 | GlslVersion::Desktop450 => false,
            };
        let underscores = version == GlslVersion::Es300 && is_kept_by_webgl(name);
        // The older names of texture functions are written as the newer ones, which nothing may hide.
        let hides = called.contains(name) || hidden.contains(name);
        // What the compatibility profile declares, the core does not, and no text may declare such names.
        let fixed = name.strip_prefix("gl_");
        if !reserved && !redefines && !underscores && !hides && fixed.is_none() {
            continue;
        }
        let mut new = match fixed {
            Some(rest) => format!("fixed_{rest}"),
            None if underscores => format!("n{}", name.replace("__", "_0_")),
            None => format!("{name}_"),
        };
        while all.contains(new.as_str()) || names.values().any(|other| *other == new) {
            new.push('0');
        }
        names.insert(name.to_owned(), new);
    }
    names
}

/// The names of the texture functions that a stage calls.
fn texture_functions(shader: &Shader) -> impl Iterator<Item = &'static str> {
    shader.exprs.iter().filter_map(|expr| match expr.kind {
        ExprKind::BuiltinCall(function, _) if matches!(function.class(), Class::Texture(_)) => Some(function.name()),
        _ => None,
    })
}

/// The names of built-in functions that the text calls and that something global of the program would hide: a function of the program,
/// which before 1.30 was an overload (GLSL 1.30 §6.1), or anything else, where the call says what the version has no other word for.
fn hidden(program: &Program, global: &BTreeSet<&str>, version: GlslVersion) -> BTreeSet<&'static str> {
    let is_builtin = |name: &&str| !functions::named(name).is_empty();
    if !global.iter().any(is_builtin) {
        return BTreeSet::new();
    }
    // What a version lacks is reported where the stage is written.
    let stages = program.stages.iter().filter_map(|shader| super::in_terms_of(program, shader, version).ok());
    let calls = stages.flat_map(|(_, shader)| shader.exprs).filter_map(|expr| match expr.kind {
        ExprKind::BuiltinCall(function, _) => Some(function.name()),
        _ => None,
    });
    calls.filter(|name| global.contains(name)).collect()
}

/// Names that GLSL ES 3.00 §3.8 and WebGL keep to themselves.
fn is_kept_by_webgl(name: &str) -> bool {
    name.contains("__") || name.starts_with("webgl_") || name.starts_with("_webgl_")
}

/// All names of a stage, and among them those at global scope.
fn collect<'a>(types: &'a Types, shader: &'a Shader, all: &mut BTreeSet<&'a str>, global: &mut BTreeSet<&'a str>) {
    for variable in shader.globals.iter().filter(|global| global.builtin.is_none()) {
        let nameless = variable.block.as_ref().is_some_and(|block| block.instance.is_none());
        let block = variable.block.iter().flat_map(|block| [Some(&block.name), block.instance.as_ref()]).flatten();
        for name in block.chain([&variable.name]) {
            all.insert(name);
            global.insert(name);
        }
        for id in structs(types, [variable.ty]) {
            let structure = types.structure(id);
            let members = structure.members.iter().map(|member| member.name.as_str());
            if nameless && structure.is_block {
                global.extend(members.clone());
            }
            all.extend(members);
        }
    }
    for function in shader.functions.iter().filter(|function| function.name != "main") {
        all.insert(&function.name);
        global.insert(&function.name);
    }
    let locals = || shader.functions.iter().flat_map(|function| &function.locals);
    all.extend(locals().map(|local| local.name.as_str()));
    for id in structs(types, all_types(shader)) {
        let structure = types.structure(id);
        all.insert(&structure.name);
        global.insert(&structure.name);
        all.extend(structure.members.iter().map(|member| member.name.as_str()));
    }
    all.remove("");
    global.remove("");
}

/// The types of everything in a stage.
fn all_types(shader: &Shader) -> Vec<TypeId> {
    let globals = shader.globals.iter().filter(|global| global.builtin.is_none()).map(|global| global.ty);
    let functions = shader.functions.iter().flat_map(|function| {
        [function.ret].into_iter().chain(function.locals.iter().map(|local| local.ty)).collect::<Vec<_>>()
    });
    globals.chain(functions).chain(shader.exprs.iter().map(|expr| expr.ty)).collect()
}

/// The structs that the core profile has.
static BUILT_IN: &[&str] = &["gl_DepthRangeParameters", "gl_PerVertex"];

/// The structs in types, without those that are built in.
fn structs(types: &Types, roots: impl IntoIterator<Item = TypeId>) -> BTreeSet<StructId> {
    let mut found = BTreeSet::new();
    let mut pending: Vec<TypeId> = roots.into_iter().collect();
    while let Some(ty) = pending.pop() {
        match types.get(ty) {
            Type::Array(element, _) => pending.push(element),
            Type::Struct(id) if !BUILT_IN.contains(&types.structure(id).name.as_str()) && found.insert(id) => {
                pending.extend(types.structure(id).members.iter().map(|member| member.ty));
            }
            _ => {}
        }
    }
    found
}

/// Gives the names of a stage that is about to be printed.
pub(super) fn apply(types: &mut Types, shader: &mut Shader, program: &Program, version: GlslVersion) {
    let names = renamed(program, version);
    if names.is_empty() {
        return;
    }
    let give = |name: &mut String| {
        if let Some(new) = names.get(name.as_str()) {
            name.clone_from(new);
        }
    };
    for id in structs(types, all_types(shader)) {
        let structure = types.structure_mut(id);
        give(&mut structure.name);
        structure.members.iter_mut().for_each(|member| give(&mut member.name));
    }
    for global in shader.globals.iter_mut().filter(|global| global.builtin.is_none()) {
        give(&mut global.name);
        if let Some(block) = &mut global.block {
            give(&mut block.name);
            block.instance.iter_mut().for_each(give);
        }
    }
    for function in &mut shader.functions {
        give(&mut function.name);
        function.locals.iter_mut().for_each(|local| give(&mut local.name));
    }
}
