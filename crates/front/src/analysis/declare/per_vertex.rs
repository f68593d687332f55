//! Redeclares `gl_PerVertex` (ARB_separate_shader_objects; 1.50 is silent, and every driver accepts it).
//!
//! The rules are those of GLSL 4.10 §7.1. The block is redeclared at most once, and before any member is used or
//! redeclared on its own. It lists a subset of the members with their own types, as `gl_in[]` for the input and
//! without an instance name for the output. Members that it omits can no longer be used.

use super::super::context::Analyzer;
use super::super::qualifiers::{DeclarationContext, StorageWord};
use super::super::state::PerVertex;
use crate::builtin::variables::{self, Row, VARIABLES};
use crate::builtin::{BuiltinVariable, fixed};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::names;
use crate::hir::{ArraySize, Member, Sampling, Stage, Storage, StructType, Type, TypeId};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast::{BlockDecl, Declarator};

impl Analyzer<'_> {
    /// `out gl_PerVertex { vec4 gl_Position; };`
    pub(super) fn redeclare_per_vertex(&mut self, block: &BlockDecl, storage: Storage, word: (StorageWord, Span)) {
        let span = block.name.span;
        if let Some(problem) = self.per_vertex_problem(block, storage) {
            self.report(problem);
            return;
        }
        self.allows(Feature::PerVertex, span);
        let members = self.per_vertex_members(block, word);
        if block.members.is_empty() {
            self.report(Diagnostic::new(&names::PER_VERTEX, span, "`gl_PerVertex` must have a member").here("empty"));
        }
        let names: Vec<String> = members.iter().map(|member| member.name.clone()).collect();
        if storage == Storage::In {
            self.redeclare_gl_in(block, members);
            return;
        }
        for member in members {
            let id = match self.per_vertex_row(&member.name) {
                Some(row) => self.builtin_global(row),
                None => match fixed::per_vertex(&member.name, self.ast.version, self.stage) {
                    Some(row) => self.fixed_global(row),
                    None => continue,
                },
            };
            if let Some(global) = self.shader.globals.get_mut(id.index()) {
                global.ty = member.ty;
                global.span = member.span;
                global.invariant |= member.invariant;
            }
        }
        self.shader.per_vertex_out = Some(crate::hir::PerVertexOut { members: Clone::clone(&names), span });
        self.layouts.per_vertex_out = Some(PerVertex { span, members: names });
    }

    /// Reports the use of a member that the redeclared block omits.
    pub(in crate::analysis) fn is_left_out(&mut self, row: &Row, span: Span) -> bool {
        let Some(block) = self.layouts.per_vertex_out.clone().filter(|_| row.per_vertex && row.storage == Storage::Out)
        else {
            return false;
        };
        if block.members.iter().any(|member| member == row.name) {
            return false;
        }
        let name = row.name;
        self.report(
            Diagnostic::new(&names::PER_VERTEX, span, format!("`{name}` is not in the redeclared `gl_PerVertex`"))
                .here("used here")
                .label(block.span, "declared again here without it")
                .help(format!("add `{name}` to the block")),
        );
        true
    }

    /// Reports the redeclaration of a member outside the redeclared block.
    pub(super) fn is_in_per_vertex(&mut self, row: &Row, span: Span) -> bool {
        let Some(block) = self.layouts.per_vertex_out.clone().filter(|_| row.per_vertex && row.storage == Storage::Out)
        else {
            return false;
        };
        let name = row.name;
        self.report(
            Diagnostic::new(&names::PER_VERTEX, span, format!("`{name}` is redeclared outside `gl_PerVertex`"))
                .here("give it its size in the block")
                .label(block.span, "the block is declared again here"),
        );
        true
    }

    fn per_vertex_problem(&self, block: &BlockDecl, storage: Storage) -> Option<Diagnostic> {
        let at = block.name.span;
        let finding =
            |message: &str, span: Span, here: &str| Some(Diagnostic::new(&names::PER_VERTEX, span, message).here(here));
        match (self.stage, storage) {
            (Stage::Vertex | Stage::Geometry, Storage::Out) | (Stage::Geometry, Storage::In) => {}
            (stage, _) => {
                let message = format!("a {} shader has no such `gl_PerVertex`", stage.name());
                return finding(&message, at, "not built in here");
            }
        }
        if storage == Storage::In {
            let good =
                block.instance.as_ref().is_some_and(|(name, dims)| self.name(*name) == "gl_in" && dims.len() == 1);
            if !good {
                let message = "the input `gl_PerVertex` is called `gl_in[]`";
                return finding(message, at, "another instance")
                    .map(|finding| finding.help("write `} gl_in[];` at its end"));
            }
        } else if let Some((name, _)) = &block.instance {
            return finding("the output `gl_PerVertex` has no instance name", name.span, "remove the name");
        }
        let used = self.declared.builtins().filter(|(variable, _)| {
            if storage == Storage::In { *variable == BuiltinVariable::In } else { is_per_vertex(*variable) }
        });
        // The earliest use, whatever the order of the table.
        let earliest = used
            .filter_map(|(_, id)| {
                let declared = Some(self.shader.global(id).span).filter(|span| span.is_known());
                self.uses.first(id).or(declared)
            })
            .min_by_key(|span| span.start);
        let earlier = match &self.layouts.per_vertex_out {
            Some(block) if storage == Storage::Out => Some(block.span),
            _ => earliest,
        };
        let earlier = earlier?;
        finding("`gl_PerVertex` is declared again too late", at, "must be the first mention")
            .map(|finding| finding.label(earlier, "mentioned here"))
    }

    fn per_vertex_members(&mut self, block: &BlockDecl, word: (StorageWord, Span)) -> Vec<Member> {
        let mut members: Vec<Member> = Vec::new();
        for row in &block.members {
            let record = self.qualifiers(&row.qualifiers, DeclarationContext::BlockMember);
            self.check_member_word(&record, word);
            let base = self.type_spec(&row.ty);
            for declarator in &row.declarators {
                self.no_member_initializer(declarator);
                self.note_precise(&row.qualifiers, declarator.name);
                let ty = self.with_array(base, &declarator.array);
                self.check_own_qualifiers(declarator.name, &record);
                let Some(member) = self.per_vertex_member(declarator, ty, record.invariant.is_some()) else { continue };
                match members.iter().find(|other| other.name == member.name) {
                    Some(other) => {
                        let message = format!("`{}` is declared twice", member.name);
                        let finding = Diagnostic::new(&names::REDEFINED, member.span, message).here("again here");
                        self.report(finding.label(other.span, "first here"));
                    }
                    None => members.push(member),
                }
            }
        }
        members
    }

    fn per_vertex_member(&mut self, declarator: &Declarator, ty: TypeId, invariant: bool) -> Option<Member> {
        let (name, span) = (self.name(declarator.name).to_owned(), declarator.name.span);
        let name = name.as_str();
        let Some(wanted) = self.per_vertex_type(name) else {
            self.report(
                Diagnostic::new(&names::PER_VERTEX, span, format!("`gl_PerVertex` has no member `{name}`"))
                    .here("only the built-in members")
                    .help("they are `gl_Position`, `gl_PointSize` and `gl_ClipDistance`"),
            );
            return None;
        };
        let fits = match (self.types.get(wanted), self.types.get(ty)) {
            (Type::Array(element, _), Type::Array(given, _)) => element == given,
            _ => wanted == ty,
        };
        if !fits && !ty.is_error() {
            let wanted = self.type_name(wanted);
            self.report(
                Diagnostic::new(&names::PER_VERTEX, span, format!("`{name}` is a `{wanted}`"))
                    .here("declared as something else"),
            );
        }
        if let (Type::Array(_, ArraySize::Sized(size)), "gl_ClipDistance") = (self.types.get(ty), name) {
            self.check_clip_distances(size, span);
        }
        Some(Member {
            name: name.to_owned(),
            ty: if fits { ty } else { wanted },
            matrix_layout: crate::hir::MatrixLayout::default(),
            interpolation: None,
            sampling: Sampling::Center,
            invariant,
            implicitly_sized: false,
            place: crate::hir::MemberPlace::default(),
            span,
        })
    }

    /// The type of a member that is built in, or that the compatibility profile adds.
    fn per_vertex_type(&mut self, name: &str) -> Option<TypeId> {
        let version = self.ast.version;
        if let Some(row) = self.per_vertex_row(name) {
            return Some(row.make_type(self.types, version));
        }
        let row = fixed::per_vertex(name, version, self.stage)?;
        Some(row.make_type(self.types, &mut |_, _| TypeId::ERROR))
    }

    fn per_vertex_row(&self, name: &str) -> Option<&'static Row> {
        let row = VARIABLES.iter().find(|row| row.name == name && row.per_vertex)?;
        row.availability.in_language(self.ast.version, self.extensions).then_some(row)
    }

    fn redeclare_gl_in(&mut self, block: &BlockDecl, members: Vec<Member>) {
        let Some((instance, dims)) = &block.instance else { return };
        let structure = StructType { name: "gl_PerVertex".into(), members, is_block: true, span: block.name.span };
        let element = self.types.add_struct(structure);
        let array = self.with_array(element, dims);
        let ty = self.sized_by_geometry(array, Storage::In, instance.span);
        let row = variables::named("gl_in", self.ast.version, self.extensions, self.stage);
        let Some(row) = row else { return };
        let id = self.builtin_global(row);
        if let Some(global) = self.shader.globals.get_mut(id.index()) {
            global.ty = ty;
            global.span = instance.span;
        }
    }
}

fn is_per_vertex(variable: BuiltinVariable) -> bool {
    VARIABLES.iter().any(|row| row.variable == variable && row.per_vertex)
}
