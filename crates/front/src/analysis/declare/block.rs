//! Declares interface blocks (§4.3.7).
//!
//! *In:* a block's declaration. *Out:* a global of a block type, and names for its members or its instance.

use super::super::context::Analyzer;
use super::super::layout::{Layout, LayoutSubject};
use super::super::qualifiers::{DeclarationContext, Qualifiers, StorageWord};
use super::super::scope::Entry;
use super::super::state::{Denoted, NoteRole};
use super::structure::MemberList;
use crate::diagnostic::codes::{names, qualifiers, types};
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place};
use crate::hir::{
    ArraySize, BlockInfo, BlockLayout, GlobalId, MatrixLayout, Member, MemberPlace, Scalar, Stage, Storage, Type,
    TypeId, VarRef,
};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast::{ArrayDim, BlockDecl, Declarator, Ident, MemberDecl, TypeBase};

/// The properties that the members of a block share.
struct BlockContext {
    storage: Storage,
    word: StorageWord,
    word_span: Span,
    matrix: MatrixLayout,
    layout: BlockLayout,
    /// Whether all of the block's layout is known. Otherwise another layout than this one may be meant.
    is_known: bool,
    /// `align` before the block, which holds for each member.
    align: Option<u32>,
}

impl Analyzer<'_> {
    /// `uniform B { .. } b[2];`
    pub(in crate::analysis) fn block(&mut self, block: &BlockDecl) {
        let record = self.qualifiers(&block.qualifiers, DeclarationContext::Block);
        let Some((word, word_span)) = record.storage else {
            self.report(
                Diagnostic::new(&qualifiers::BLOCK, block.name.span, "a block must be `in`, `out` or `uniform`")
                    .here("no storage qualifier before it"),
            );
            self.poison_block(block);
            return;
        };
        let Some(storage) = self.block_storage(word, word_span) else {
            self.poison_block(block);
            return;
        };
        let feature = if storage == Storage::Uniform { Feature::UniformBlocks } else { Feature::InterfaceBlocks };
        self.require(feature, block.name.span);
        if let Some((instance, _)) = &block.instance {
            self.require(Feature::BlockInstances, instance.span);
        }
        let name = self.name(block.name);
        if name == "gl_PerVertex" {
            self.redeclare_per_vertex(block, storage, (word, word_span));
            return;
        }
        let is_uniform = storage == Storage::Uniform;
        let subject = if is_uniform { LayoutSubject::UniformBlock } else { LayoutSubject::VaryingBlock };
        let layout = self.layout(&record, subject);
        let good_name = self.check_name(block.name);
        if good_name {
            self.enter_block_name(block.name, storage);
        }
        let matrix = layout.matrix.unwrap_or(self.layouts.block_defaults.matrix);
        let mut context = BlockContext {
            storage,
            word,
            word_span,
            matrix,
            layout: layout.block.unwrap_or(self.layouts.block_defaults.layout),
            is_known: layout.is_known,
            align: None,
        };
        if let Some((value, span)) = layout.align
            && self.is_std140(&context, "align", span)
            && self.is_alignment(value, span)
        {
            context.align = Some(value);
        }
        self.note_precise(&block.qualifiers, block.instance.as_ref().map_or(block.name, |(instance, _)| *instance));
        let members = self.block_members(block, &context);
        self.check_member_locations(block, &members, layout.location.is_some());
        if members.is_empty() {
            self.report(
                Diagnostic::new(&qualifiers::BLOCK, block.name.span, "a block must have a member").here("empty"),
            );
        }
        let ty = self.add_structure(name, members, true, block.name.span);
        if let Type::Struct(id) = self.types.get(ty) {
            self.note(block.name.span, Denoted::Block(id), NoteRole::Declares);
        }
        self.note_members(ty, &block.members);
        self.add_block(block, ty, storage, &layout, &record);
    }

    /// Enters the names of an invalid block as poison, so that their uses raise no more messages.
    fn poison_block(&mut self, block: &BlockDecl) {
        match &block.instance {
            Some((instance, _)) => self.enter(*instance, Entry::Poison),
            None => {
                for declarator in block.members.iter().flat_map(|row| &row.declarators) {
                    self.enter(declarator.name, Entry::Poison);
                }
            }
        }
    }

    fn block_storage(&mut self, word: StorageWord, span: Span) -> Option<Storage> {
        let storage = match word {
            StorageWord::Uniform => Storage::Uniform,
            StorageWord::In => Storage::In,
            StorageWord::Out => Storage::Out,
            StorageWord::Attribute | StorageWord::Varying | StorageWord::VaryingOut | StorageWord::Inout => {
                let message = format!("a block cannot be `{}`", word.spelling());
                self.report(
                    Diagnostic::new(&qualifiers::BLOCK, span, message).here("a block is `in`, `out` or `uniform`"),
                );
                return None;
            }
        };
        let refused = match (self.stage, storage) {
            (Stage::Vertex, Storage::In) => "an input block in a vertex shader",
            (Stage::Fragment, Storage::Out) => "an output block in a fragment shader",
            _ => return Some(storage),
        };
        self.report(
            Diagnostic::new(&qualifiers::BLOCK, span, refused)
                .here("not allowed")
                .help("declare its members one by one"),
        );
        None
    }

    fn block_members(&mut self, block: &BlockDecl, context: &BlockContext) -> MemberList {
        let mut members = MemberList::default();
        for row in &block.members {
            let record = self.qualifiers(&row.qualifiers, DeclarationContext::BlockMember);
            self.check_member_storage(&record, context);
            let subject = if context.storage == Storage::Uniform {
                LayoutSubject::UniformMember
            } else {
                LayoutSubject::VaryingMember
            };
            let layout = self.layout(&record, subject);
            let base = self.block_member_base(row);
            self.check_precision(record.precision, base, row.ty.span);
            for declarator in &row.declarators {
                self.note_precise(&row.qualifiers, declarator.name);
                self.no_member_initializer(declarator);
                let ty = self.with_array(base, &declarator.array);
                let ty = self.check_member_type(ty, row, &record, context, declarator.name.span);
                self.require_size(ty, declarator.name.span);
                let must_match = self.ast.version.is_es() && !self.ast.version.has(Feature::BlockPrecisions);
                if context.storage == Storage::Uniform && must_match {
                    let name = format!("{}.{}", self.name(block.name), self.name(declarator.name));
                    self.note_precision(name, record.precision, ty, declarator.name.span);
                }
                let matrix = layout.matrix.unwrap_or(context.matrix);
                let place = self.member_place(&layout, context);
                let member = self.block_member(declarator, ty, &record, (matrix, place), context.storage);
                self.add_member(&mut members, declarator.name, member);
            }
        }
        members
    }

    fn check_member_storage(&mut self, record: &Qualifiers, context: &BlockContext) {
        self.check_member_word(record, (context.word, context.word_span));
        if let (Some(span), Storage::In) = (record.invariant, context.storage) {
            self.require(Feature::InvariantInputs, span);
        }
        if context.storage == Storage::Uniform || (self.stage == Stage::Vertex && context.storage == Storage::In) {
            self.no_interpolation(record, "a member of a uniform block");
        }
    }

    /// Reports a member with another storage qualifier than its block (§4.3.7).
    pub(super) fn check_member_word(&mut self, record: &Qualifiers, (block, block_span): (StorageWord, Span)) {
        let Some((word, span)) = record.storage.filter(|(word, _)| *word != block) else { return };
        let (member, block) = (word.spelling(), block.spelling());
        self.report(
            Diagnostic::new(&qualifiers::BLOCK, span, format!("a member cannot be `{member}` in an `{block}` block"))
                .here("another storage than the block")
                .label(block_span, format!("the block is `{block}`"))
                .help(Advice::new(Applicability::Unsafe, "remove it", Place::Over, "")),
        );
    }

    fn block_member_base(&mut self, row: &MemberDecl) -> TypeId {
        if let TypeBase::Struct(_) = &row.ty.base {
            self.report(
                Diagnostic::new(&types::STRUCT, row.ty.span, "a struct cannot be declared inside a struct or block")
                    .here("declare it before"),
            );
            return TypeId::ERROR;
        }
        self.type_spec(&row.ty)
    }

    fn check_member_type(
        &mut self,
        ty: TypeId,
        row: &MemberDecl,
        record: &Qualifiers,
        context: &BlockContext,
        name: Span,
    ) -> TypeId {
        let span = row.ty.span;
        let refused = if ty == TypeId::VOID {
            Some((&types::VOID_VALUE, "a member cannot be `void`"))
        } else if self.types.contains_sampler(ty) {
            Some((&types::SAMPLER, "a sampler cannot be in a block"))
        } else if context.storage != Storage::Uniform && self.types.summary(ty).holds(&[Scalar::Bool]) {
            Some((&qualifiers::INTERFACE_TYPE, "booleans cannot pass between stages"))
        } else {
            None
        };
        if let Some((code, message)) = refused {
            self.report(Diagnostic::new(code, span, message).here("not allowed here").label(name, "declared here"));
            return TypeId::ERROR;
        }
        if let Some(what) = self.not_flat(ty, context.storage, record) {
            self.report(
                Diagnostic::new(&qualifiers::INTEGER_NOT_FLAT, span, what)
                    .here("integers are not interpolated")
                    .label(name, "declared here")
                    .help(Advice::new(
                        Applicability::Unsafe,
                        "write `flat` before it, on both sides",
                        Place::Before,
                        "flat ",
                    )),
            );
        }
        ty
    }

    /// The place that the layout of a member asks for (4.40 §4.4.1, §4.4.5).
    fn member_place(&mut self, layout: &Layout, context: &BlockContext) -> MemberPlace {
        let offset = layout.offset.filter(|(_, span)| self.is_std140(context, "offset", *span));
        let align = layout.align.filter(|(_, span)| self.is_std140(context, "align", *span));
        let align = align.filter(|(value, span)| self.is_alignment(*value, *span)).map(|(value, _)| value);
        MemberPlace {
            offset: offset.map(|(value, _)| value),
            align: align.or(context.align).unwrap_or(0),
            location: layout.location.map(|(value, _)| value),
            component: layout.component.map(|(value, _)| value),
        }
    }

    /// Whether a block may have offsets and alignments: those of the other layouts are the implementation's.
    fn is_std140(&mut self, context: &BlockContext, what: &str, span: Span) -> bool {
        let is_std140 = context.layout == BlockLayout::Std140;
        if !is_std140 && context.is_known {
            self.report(
                Diagnostic::new(
                    &qualifiers::LAYOUT_PLACE,
                    span,
                    format!("`{what}` needs a block of the layout `std140`"),
                )
                .here("the block has another layout")
                .help("write `layout(std140)` before the block"),
            );
        }
        is_std140
    }

    /// Whether an alignment is a power of two; if not, that is reported.
    fn is_alignment(&mut self, value: u32, span: Span) -> bool {
        if !value.is_power_of_two() {
            self.report(
                Diagnostic::new(&qualifiers::LAYOUT_VALUE, span, format!("`align = {value}` is not a power of two"))
                    .here("an alignment in bytes: 1, 2, 4, 8 and so on"),
            );
        }
        value.is_power_of_two()
    }

    fn block_member(
        &self,
        declarator: &Declarator,
        ty: TypeId,
        record: &Qualifiers,
        (matrix_layout, place): (MatrixLayout, MemberPlace),
        storage: Storage,
    ) -> Member {
        let invariant_all = self.ast.invariant_all.is_some() && storage == Storage::Out;
        Member {
            name: self.name(declarator.name).to_owned(),
            ty,
            matrix_layout,
            interpolation: record.interpolation.map(|(word, _)| word),
            sampling: record.sampling(),
            invariant: record.invariant.is_some() || invariant_all,
            implicitly_sized: false,
            place,
            span: declarator.name.span,
        }
    }

    /// "If a block has no location, either all or none of its members have one" (4.40 §4.4.1).
    fn check_member_locations(&mut self, block: &BlockDecl, members: &MemberList, has_location: bool) {
        let located = members.list().iter().filter(|member| member.place.location.is_some()).count();
        if has_location || located == 0 || located == members.list().len() {
            return;
        }
        let message = "some members of this block have a location, and some have none";
        self.report(
            Diagnostic::new(&qualifiers::LAYOUT_VALUE, block.name.span, message)
                .here("without a location of its own")
                .help("give the block a location, or each member"),
        );
    }

    /// Adds the block as a global, and enters its members or its instance.
    fn add_block(&mut self, block: &BlockDecl, ty: TypeId, storage: Storage, layout: &Layout, record: &Qualifiers) {
        let name = self.name(block.name);
        let ty = match &block.instance {
            Some((instance, dims)) => self.block_array(ty, storage, *instance, dims),
            None => {
                self.require_geometry_array(storage, block.name.span);
                ty
            }
        };
        let ty = if self.check_global_size(ty, storage, true, block.name.span) { ty } else { TypeId::ERROR };
        self.check_places(layout, ty, true);
        let (span, own_name) = match &block.instance {
            Some((instance, _)) => (instance.span, self.name(*instance)),
            None => (block.name.span, name),
        };
        let mut global = self.new_global(span, own_name, ty, storage, record, layout, None);
        // The block's binding is in its record, and invariance is a property of each member.
        (global.binding, global.invariant) = (None, false);
        global.block = Some(BlockInfo {
            name: name.to_owned(),
            instance: block.instance.as_ref().map(|(instance, _)| self.name(*instance).to_owned()),
            layout: layout.block.unwrap_or(self.layouts.block_defaults.layout),
            binding: layout.binding.map(|(value, _)| value),
        });
        let id = self.add_global(global);
        match &block.instance {
            Some((instance, _)) => {
                if self.check_name(*instance) && self.check_block_name(*instance) {
                    let entry = if ty.is_error() { Entry::Poison } else { Entry::Variable(VarRef::Global(id)) };
                    self.enter(*instance, entry);
                }
            }
            None => self.enter_members(block, id, ty),
        }
    }

    fn enter_members(&mut self, block: &BlockDecl, id: GlobalId, ty: TypeId) {
        let Type::Struct(structure) = self.types.get(ty) else { return };
        for declarator in block.members.iter().flat_map(|row| &row.declarators) {
            if let Some(index) = self.member_index(structure, declarator.name)
                && self.check_block_name(declarator.name)
            {
                self.enter(declarator.name, Entry::Member(id, index));
            }
        }
    }

    /// The type of an instance. An array needs a size, except for geometry inputs, which must be arrays.
    fn block_array(&mut self, ty: TypeId, storage: Storage, instance: Ident, dims: &[ArrayDim]) -> TypeId {
        let array = self.with_array(ty, dims);
        let is_geometry_input = self.stage == Stage::Geometry && storage == Storage::In;
        match self.types.get(array) {
            Type::Array(_, ArraySize::Unsized) if !is_geometry_input => {
                self.report(
                    Diagnostic::new(&types::UNSIZED_ARRAY, instance.span, "an array of blocks must have a size")
                        .here("no size given"),
                );
                TypeId::ERROR
            }
            Type::Array(..) => self.sized_by_geometry(array, storage, instance.span),
            _ => {
                self.require_geometry_array(storage, instance.span);
                array
            }
        }
    }

    fn require_geometry_array(&mut self, storage: Storage, span: Span) {
        if self.stage == Stage::Geometry && storage == Storage::In {
            self.report(
                Diagnostic::new(&qualifiers::GEOMETRY_INPUT, span, "an input of a geometry shader must be an array")
                    .here("one element for each vertex of the primitive")
                    .help("give the block an instance name with `[]`"),
            );
        }
    }

    /// Enters a block name. It must have no other use, and occur once per interface.
    fn enter_block_name(&mut self, name: Ident, storage: Storage) {
        let spelling = self.name(name);
        let taken = match self.declared.block_of_interface(name.symbol, storage) {
            Some(earlier) => Some(earlier),
            None => self.scopes.find_here(name.symbol).map(|binding| binding.span),
        };
        self.declared.add_block(name.symbol, storage, name.span);
        if let Some(earlier) = taken {
            self.report(
                Diagnostic::new(&names::REDEFINED, name.span, format!("the block name `{spelling}` is taken"))
                    .here("declared again here")
                    .label(earlier, "first declared here"),
            );
        }
    }

    /// Checks that a global name is not also the name of a block (§4.3.7).
    pub(in crate::analysis) fn check_block_name(&mut self, name: Ident) -> bool {
        if !self.scopes.is_global() {
            return true;
        }
        let Some(block) = self.declared.block(name.symbol) else { return true };
        let spelling = self.name(name);
        self.report(
            Diagnostic::new(&names::BLOCK_NAME, name.span, format!("`{spelling}` is the name of a block"))
                .here("cannot name anything else")
                .label(block, "the block"),
        );
        false
    }
}
