//! Names for the printer: each struct, function and global keeps its name; a name that is taken gets a number.
//!
//! Locals get names that are unique within their function and among all globals, so that scopes do not matter.

use crate::builtin::{BuiltinVariable, functions};
use crate::hir::{Function, FunctionId, GlobalId, LocalId, Shader, StructId, Type, TypeId, Types};
use rustc_hash::{FxHashMap, FxHashSet};

/// The name of everything that the printer writes.
pub(super) struct NameTable {
    structs: FxHashMap<StructId, String>,
    struct_order: Vec<StructId>,
    globals: Vec<String>,
    functions: Vec<String>,
    locals: Vec<Vec<String>>,
}

/// Names the locals of a function, given the names of everything global.
pub(super) type ScopedNames<'a> = &'a dyn Fn(&NameTable, &Function) -> Vec<String>;

/// The names that are taken.
#[derive(Default)]
struct Taken {
    names: FxHashSet<String>,
    /// The last number behind each name that was taken.
    last: FxHashMap<String, u32>,
}

impl Taken {
    fn claim(&mut self, wanted: &str) -> String {
        if self.names.insert(wanted.to_owned()) {
            return wanted.to_owned();
        }
        let gap = if wanted.ends_with('_') { "" } else { "_" };
        let number = self.last.entry(wanted.to_owned()).or_insert(1);
        loop {
            *number += 1;
            let name = format!("{wanted}{gap}{number}");
            if self.names.insert(name.clone()) {
                return name;
            }
        }
    }
}

impl NameTable {
    /// The names of a shader. If `scoped` names the locals of a function, it takes the place of unique names.
    pub(super) fn new(
        types: &Types,
        shader: &Shader,
        builtin_name: &dyn Fn(BuiltinVariable) -> &'static str,
        scoped: Option<ScopedNames<'_>>,
    ) -> Self {
        let mut taken = Taken::default();
        let name = |global| global_name(types, &mut taken, builtin_name, global);
        let globals: Vec<String> = shader.globals.iter().map(name).collect();
        let functions = function_names(shader, &mut taken);
        let mut structs = FxHashMap::default();
        let struct_order = used_structs(types, shader);
        for &id in &struct_order {
            let name = match types.structure(id).name.as_str() {
                "" => taken.claim(&unnamed(types, id)),
                name => taken.claim(name),
            };
            structs.insert(id, name);
        }
        let mut table = Self { structs, struct_order, globals, functions, locals: Vec::new() };
        for function in &shader.functions {
            if let Some(scoped) = scoped {
                let names = scoped(&table, function);
                table.locals.push(names);
                continue;
            }
            let mut names = Taken::default();
            let locals = function.locals.iter().map(|local| table.local_name(&taken, &mut names, &local.name));
            let locals = locals.collect();
            table.locals.push(locals);
        }
        table
    }

    fn local_name(&self, global: &Taken, taken: &mut Taken, name: &str) -> String {
        if name.is_empty() {
            return String::new();
        }
        loop {
            let claimed = taken.claim(name);
            if !global.names.contains(&claimed) && functions::named(&claimed).is_empty() {
                return claimed;
            }
        }
    }

    pub(super) fn structure(&self, id: StructId) -> &str {
        self.structs.get(&id).map_or("", String::as_str)
    }

    /// The structs to declare, members before the structs that contain them.
    pub(super) fn structs(&self) -> &[StructId] {
        &self.struct_order
    }

    pub(super) fn global(&self, id: GlobalId) -> &str {
        self.globals.get(id.index()).map_or("", String::as_str)
    }

    pub(super) fn function(&self, id: FunctionId) -> &str {
        self.functions.get(id.index()).map_or("", String::as_str)
    }

    pub(super) fn local(&self, function: FunctionId, id: LocalId) -> &str {
        self.locals.get(function.index()).and_then(|locals| locals.get(id.index())).map_or("", String::as_str)
    }
}

/// The name of a struct without one. All stages of a program give it the same, since uniforms of the struct match by its name.
fn unnamed(types: &Types, id: StructId) -> String {
    let is_before = |other: &TypeId| matches!(types.get(*other), Type::Struct(other) if other < id && types.structure(other).name.is_empty());
    match types.ids().filter(is_before).count() {
        0 => "Unnamed".to_owned(),
        before => format!("Unnamed_{}", before + 1),
    }
}

/// The name of a global: for a block its instance name. Without one, the members are global names.
fn global_name(
    types: &Types,
    taken: &mut Taken,
    builtin_name: &dyn Fn(BuiltinVariable) -> &'static str,
    global: &crate::hir::Global,
) -> String {
    if let Some(builtin) = global.builtin {
        let name = builtin_name(builtin);
        taken.names.insert(name.to_owned());
        return name.to_owned();
    }
    match &global.block {
        None => taken.claim(&global.name),
        Some(block) => {
            taken.names.insert(block.name.clone());
            match &block.instance {
                Some(instance) => taken.claim(instance),
                None => {
                    for member in members(types, global.ty) {
                        taken.names.insert(member);
                    }
                    String::new()
                }
            }
        }
    }
}

pub(super) fn members(types: &Types, ty: TypeId) -> Vec<String> {
    match types.get(ty) {
        Type::Struct(id) => types.structure(id).members.iter().map(|member| member.name.clone()).collect(),
        _ => Vec::new(),
    }
}

/// The names of the functions; overloads share one.
fn function_names(shader: &Shader, taken: &mut Taken) -> Vec<String> {
    let mut known: FxHashMap<&str, String> = FxHashMap::default();
    let mut names = Vec::new();
    for function in &shader.functions {
        let name = known.entry(&function.name).or_insert_with(|| taken.claim(&function.name));
        names.push(name.clone());
    }
    names
}

/// All structs that the shader uses, except blocks and built-in structs, members before the structs that contain
/// them.
fn used_structs(types: &Types, shader: &Shader) -> Vec<StructId> {
    let mut order = Vec::new();
    let mut seen = FxHashSet::default();
    let globals = shader.globals.iter().filter(|global| global.builtin.is_none()).map(|global| global.ty);
    let functions = shader.functions.iter();
    let locals = functions.flat_map(|function| {
        [function.ret].into_iter().chain(function.locals.iter().map(|local| local.ty)).collect::<Vec<_>>()
    });
    let exprs = shader.exprs.iter().map(|expr| expr.ty);
    for ty in globals.chain(locals).chain(exprs) {
        add_structs(types, ty, &mut seen, &mut order);
    }
    order.retain(|&id| !types.structure(id).is_block && !types.structure(id).name.starts_with("gl_"));
    order
}

fn add_structs(types: &Types, ty: TypeId, seen: &mut FxHashSet<StructId>, order: &mut Vec<StructId>) {
    match types.get(ty) {
        Type::Array(element, _) => add_structs(types, element, seen, order),
        Type::Struct(id) if seen.insert(id) => {
            for member in &types.structure(id).members {
                add_structs(types, member.ty, seen, order);
            }
            order.push(id);
        }
        _ => {}
    }
}
