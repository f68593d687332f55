//! [`Declared`]: types, functions, blocks and built-in variables by name.

use crate::builtin::BuiltinVariable;
use crate::hir::{FunctionId, GlobalId, Storage, StructId, TypeId};
use crate::language::Precision;
use crate::source::Span;
use crate::syntax::token::Symbol;
use rustc_hash::{FxHashMap, FxHashSet};
use smallvec::SmallVec;

/// The types of a function's parameters.
pub(in crate::analysis) type Signature = SmallVec<[TypeId; 4]>;

/// Types, functions, blocks, members and built-in variables by name.
#[derive(Debug, Default)]
pub(in crate::analysis) struct Declared {
    /// The type of each type keyword met so far.
    keyword_types: FxHashMap<Symbol, TypeId>,
    functions: FxHashMap<(Symbol, Signature), FunctionId>,
    /// The functions that have a prototype.
    prototypes: FxHashSet<FunctionId>,
    /// The functions whose parameters could not all be read.
    partial: FxHashSet<FunctionId>,
    /// The names of all blocks, which have no other meaning at global scope (§4.3.7).
    blocks: FxHashMap<Symbol, Span>,
    /// The names of blocks by the interface that they are part of.
    blocks_of_interfaces: FxHashMap<(Symbol, Storage), Span>,
    /// The indices of the members, for structs with many members.
    members: FxHashMap<StructId, FxHashMap<Symbol, u32>>,
    /// In ES, the precisions of the members of structs, by declaration or default.
    precisions: FxHashMap<StructId, Vec<Option<Precision>>>,
    /// The built-in variables that are used or redeclared.
    builtins: FxHashMap<BuiltinVariable, GlobalId>,
    /// The variables of the fixed-function pipeline that are used or redeclared, and its structs.
    fixed: FxHashMap<&'static str, GlobalId>,
    fixed_structs: FxHashMap<&'static str, TypeId>,
    /// The arrays of the fixed-function pipeline that are declared again with a size.
    resized: FxHashMap<&'static str, Span>,
}

impl Declared {
    /// The type of a type keyword, if it has been met.
    pub(in crate::analysis) fn keyword_type(&self, keyword: Symbol) -> Option<TypeId> {
        self.keyword_types.get(&keyword).copied()
    }

    /// Enters the type of a type keyword.
    pub(in crate::analysis) fn add_keyword_type(&mut self, keyword: Symbol, ty: TypeId) {
        self.keyword_types.insert(keyword, ty);
    }

    /// The function with this name and exactly these parameters.
    pub(in crate::analysis) fn function(&self, name: Symbol, parameters: Signature) -> Option<FunctionId> {
        self.functions.get(&(name, parameters)).copied()
    }

    /// Enters a function.
    pub(in crate::analysis) fn add_function(&mut self, name: Symbol, parameters: Signature, id: FunctionId) {
        self.functions.insert((name, parameters), id);
    }

    /// Notes that the parameters of a function are not all known.
    pub(in crate::analysis) fn add_partial(&mut self, id: FunctionId) {
        self.partial.insert(id);
    }

    /// Whether the parameters of a function are not all known.
    pub(in crate::analysis) fn is_partial(&self, id: FunctionId) -> bool {
        self.partial.contains(&id)
    }

    /// Notes a prototype of a function. Returns whether it is the first.
    pub(in crate::analysis) fn prototype(&mut self, id: FunctionId) -> bool {
        self.prototypes.insert(id)
    }

    /// The first declaration of a block with this name.
    pub(in crate::analysis) fn block(&self, name: Symbol) -> Option<Span> {
        self.blocks.get(&name).copied()
    }

    /// The first declaration of a block with this name on an interface.
    pub(in crate::analysis) fn block_of_interface(&self, name: Symbol, storage: Storage) -> Option<Span> {
        self.blocks_of_interfaces.get(&(name, storage)).copied()
    }

    /// Enters a block. The first declaration of a name stays.
    pub(in crate::analysis) fn add_block(&mut self, name: Symbol, storage: Storage, span: Span) {
        self.blocks.entry(name).or_insert(span);
        self.blocks_of_interfaces.entry((name, storage)).or_insert(span);
    }

    /// The indices of the members by name, for structs with many members.
    pub(in crate::analysis) fn members(&self, id: StructId) -> Option<&FxHashMap<Symbol, u32>> {
        self.members.get(&id)
    }

    /// Enters the indices of the members of a struct.
    pub(in crate::analysis) fn add_members(&mut self, id: StructId, indices: FxHashMap<Symbol, u32>) {
        self.members.insert(id, indices);
    }

    /// In ES, the precisions of the members of a struct.
    pub(in crate::analysis) fn precisions(&self, id: StructId) -> &[Option<Precision>] {
        self.precisions.get(&id).map_or(&[], Vec::as_slice)
    }

    /// Enters the precisions of the members of a struct.
    pub(in crate::analysis) fn add_precisions(&mut self, id: StructId, list: Vec<Option<Precision>>) {
        self.precisions.insert(id, list);
    }

    /// The global of a built-in variable, if it is used or redeclared.
    pub(in crate::analysis) fn builtin(&self, variable: BuiltinVariable) -> Option<GlobalId> {
        self.builtins.get(&variable).copied()
    }

    /// The global of a variable of the fixed-function pipeline, if it is used or redeclared.
    pub(in crate::analysis) fn fixed(&self, name: &str) -> Option<GlobalId> {
        self.fixed.get(name).copied()
    }

    /// Enters the global of such a variable.
    pub(in crate::analysis) fn add_fixed(&mut self, name: &'static str, id: GlobalId) {
        self.fixed.insert(name, id);
    }

    /// Where such an array was given a size.
    pub(in crate::analysis) fn resized_fixed(&self, name: &str) -> Option<Span> {
        self.resized.get(name).copied()
    }

    /// Notes that such an array is given a size.
    pub(in crate::analysis) fn resize_fixed(&mut self, name: &'static str, at: Span) {
        self.resized.insert(name, at);
    }

    /// A struct of the fixed-function pipeline, which its first use makes.
    pub(in crate::analysis) fn fixed_struct(&mut self, name: &'static str, make: impl FnOnce() -> TypeId) -> TypeId {
        *self.fixed_structs.entry(name).or_insert_with(make)
    }

    /// All built-in variables that are used or redeclared, in no order.
    pub(in crate::analysis) fn builtins(&self) -> impl Iterator<Item = (BuiltinVariable, GlobalId)> {
        self.builtins.iter().map(|(&variable, &id)| (variable, id))
    }

    /// Enters the global of a built-in variable.
    pub(in crate::analysis) fn add_builtin(&mut self, variable: BuiltinVariable, id: GlobalId) {
        self.builtins.insert(variable, id);
    }
}
