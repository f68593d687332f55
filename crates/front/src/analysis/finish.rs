//! The checks that need the whole shader: sizes of arrays that follow from their uses (§4.1.9), recursion (§6.1),
//! static use (§3.8), and outputs that exclude each other (§7.2).

use super::context::Analyzer;
use super::state::ArrayKey;
use crate::builtin::BuiltinVariable;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::general::NOT_SUPPORTED_YET;
use crate::diagnostic::codes::qualifiers;
use crate::hir::{ArraySize, ExprKind, Global, GlobalId, LocalId, Stage, StmtKind, Storage, Type, TypeId, VarRef};
use crate::language::{Feature, Since};
use crate::source::Span;
use crate::syntax::of_version;

impl Analyzer<'_> {
    /// Checks that the version has the stage: geometry shaders came with GLSL 1.50 and GLSL ES 3.20.
    pub(super) fn check_stage(&mut self) {
        let (version, since) = (self.ast.version, Since::new(150, 320));
        if self.stage != Stage::Geometry || version.reaches(since) {
            return;
        }
        let first = self.ast.declarations.first().map_or(Span::default(), |first| first.span);
        let span = if version.span.is_known() { version.span } else { first };
        let message = format!("geometry shaders are not in {}", version.name());
        let finding = Diagnostic::new(&qualifiers::NEEDS_EXTENSION, span, message).here("not in this version");
        let remedy = version.first(since).map(|line| format!("`{line}` has them"));
        self.report(of_version(finding.maybe_help(remedy), version));
    }

    /// Completes the shader.
    pub(super) fn finish(&mut self) {
        self.size_arrays();
        self.retype();
        self.check_recursion();
        self.shader.mark_static_use();
        self.check_fragment_outputs();
        self.check_output_locations();
        self.check_clipping();
        self.check_early_tests();
        self.check_pragma();
    }

    /// `early_fragment_tests` (4.20 §4.4.1.3) makes no difference to a shader that neither discards nor writes a depth. For
    /// others, the depth buffer would be written before the shader runs, which is not supported.
    fn check_early_tests(&mut self) {
        let Some(span) = self.layouts.early_tests else { return };
        let is_depth = |global: &Global| global.builtin == Some(BuiltinVariable::FragDepth) && global.written;
        let mut differs = self.shader.globals.iter().any(is_depth);
        for body in self.shader.functions.iter().filter(|one| one.reachable).filter_map(|one| one.body.as_deref()) {
            self.shader.visit_statements(body, &mut |statement| differs |= matches!(statement.kind, StmtKind::Discard));
        }
        if differs {
            let message = "`early_fragment_tests` of a shader that discards or writes a depth is not supported yet";
            self.report(Diagnostic::new(&NOT_SUPPORTED_YET, span, message));
        }
    }

    /// Gives each array without a size the size that its uses require.
    fn size_arrays(&mut self) {
        for index in 0..self.shader.globals.len() {
            let id = GlobalId::new(index);
            let global = self.shader.global(id);
            let is_geometry_input = self.stage == Stage::Geometry && global.storage == Storage::In;
            let (ty, is_block) = (global.ty, global.block.is_some());
            match self.types.get(ty) {
                Type::Array(element, ArraySize::Unsized) if !is_geometry_input => {
                    let is_clip_distance = global.builtin == Some(BuiltinVariable::ClipDistance);
                    let ty = self.sized_by_use(ArrayKey::Global(id), element, is_clip_distance);
                    if let Some(global) = self.shader.globals.get_mut(index) {
                        (global.ty, global.implicitly_sized) = (ty, true);
                    }
                }
                _ if is_block => self.size_members(id, ty),
                _ => {}
            }
        }
    }

    fn size_members(&mut self, id: GlobalId, ty: TypeId) {
        let Type::Struct(structure) = self.types.get(self.element_of(ty)) else { return };
        for index in 0..self.types.structure(structure).members.len() {
            let Some(member) = self.types.structure(structure).members.get(index) else { continue };
            let is_clip_distance = member.name == BuiltinVariable::ClipDistance.name();
            if let Type::Array(element, ArraySize::Unsized) = self.types.get(member.ty) {
                let ty = self.sized_by_use(ArrayKey::Member(id, index as u32), element, is_clip_distance);
                if let Some(member) = self.types.structure_mut(structure).members.get_mut(index) {
                    (member.ty, member.implicitly_sized) = (ty, true);
                }
            }
        }
    }

    /// The array type that covers all elements that are used.
    pub(super) fn sized_by_use(&mut self, key: ArrayKey, element: TypeId, is_clip_distance: bool) -> TypeId {
        let largest = self.uses.largest_index(key);
        // An array that is never indexed needs some size to exist; nothing determines which.
        let size = largest.map_or(1, |(index, _)| index.saturating_add(1));
        if let Some((_, span)) = largest.filter(|_| is_clip_distance) {
            self.check_clip_distances(size, span);
        }
        self.types.array(element, ArraySize::Sized(size))
    }

    /// Does the same for the locals of the function that was just analyzed, whose expressions begin at `first`.
    pub(super) fn size_locals(&mut self, first: usize) {
        let Some(n_locals) = self.current_function().map(|function| function.locals.len()) else { return };
        let mut any = false;
        for index in 0..n_locals {
            let id = LocalId::new(index);
            let Some(ty) = self.local(id).map(|local| local.ty) else { continue };
            if let Type::Array(element, ArraySize::Unsized) = self.types.get(ty) {
                let ty = self.sized_by_use(ArrayKey::Local(id), element, false);
                any = true;
                if let Some(local) = self.current_function().and_then(|function| function.locals.get_mut(index)) {
                    local.ty = ty;
                }
            }
        }
        if any || self.uses.any_local_array() {
            for index in first..self.shader.exprs.len() {
                let Some(ExprKind::Var(VarRef::Local(id))) = self.shader.exprs.get(index).map(|expr| &expr.kind) else {
                    continue;
                };
                let ty = self.local(*id).map(|local| local.ty);
                if let (Some(ty), Some(expr)) = (ty, self.shader.exprs.get_mut(index)) {
                    expr.ty = ty;
                }
            }
        }
        self.uses.end_function();
    }

    /// Updates the types of expressions that name such arrays. Children come before their parents.
    fn retype(&mut self) {
        for index in 0..self.shader.exprs.len() {
            let Some(expr) = self.shader.exprs.get(index) else { continue };
            if !matches!(self.types.get(expr.ty), Type::Array(_, ArraySize::Unsized)) {
                continue;
            }
            let ty = match expr.kind {
                ExprKind::Var(VarRef::Global(id)) => self.shader.global(id).ty,
                ExprKind::Member(base, member) => match self.types.get(self.ty(base)) {
                    Type::Struct(id) => {
                        let members = &self.types.structure(id).members;
                        members.get(member as usize).map_or(TypeId::ERROR, |member| member.ty)
                    }
                    _ => continue,
                },
                _ => continue,
            };
            if let Some(expr) = self.shader.exprs.get_mut(index) {
                expr.ty = ty;
            }
        }
    }

    /// Checks that `#pragma STDGL invariant(all)` is in a shader whose outputs another stage reads (§4.6.1).
    fn check_pragma(&mut self) {
        let allowed = self.stage != Stage::Fragment
            || [Feature::FragmentPragma, Feature::EarlyFragmentPragma]
                .iter()
                .any(|feature| self.ast.version.has(*feature));
        if let Some(span) = self.ast.invariant_all.filter(|_| !allowed) {
            self.report(
                Diagnostic::new(
                    &qualifiers::INVARIANT,
                    span,
                    "`#pragma STDGL invariant(all)` is not allowed in a fragment shader",
                )
                .help("remove it, or make single inputs `invariant`"),
            );
        }
    }

    /// Checks that a shader statically assigns only one of `gl_FragColor`, `gl_FragData` and its own outputs (§7.2): what a function
    /// writes that nothing calls counts, too (§3.8).
    fn check_fragment_outputs(&mut self) {
        let is_old = |variable| self.declared.builtin(variable).is_some();
        let any_old = is_old(BuiltinVariable::FragColor) || is_old(BuiltinVariable::FragData);
        if self.stage != Stage::Fragment || self.shader.mixes_outputs || !any_old {
            return;
        }
        let assigned = self.shader.statically_written();
        let written = |builtin: Option<BuiltinVariable>| {
            let mut outputs = self.shader.globals().filter(|(_, global)| global.storage == Storage::Out);
            outputs.find(|(id, global)| assigned.contains(id) && global.builtin == builtin)
        };
        let color = written(Some(BuiltinVariable::FragColor));
        let data = written(Some(BuiltinVariable::FragData));
        let own = written(None);
        let pair = match (color, data, own) {
            (Some(first), Some(second), _) | (Some(first), _, Some(second)) | (_, Some(first), Some(second)) => {
                (first, second)
            }
            _ => return,
        };
        let ((first_id, first), (second_id, second)) = pair;
        let at = |id| self.uses.first(id).unwrap_or_default();
        let finding = Diagnostic::new(
            &qualifiers::OUTPUTS_EXCLUDE,
            at(second_id),
            format!("`{}` and `{}` cannot both be written", first.name, second.name),
        )
        .here("the second kind of output")
        .label(at(first_id), "the first kind of output")
        .help("declare an `out` variable for each color, and write only those");
        self.report(finding);
    }

    /// Checks that several outputs of a fragment shader all have a location in GLSL ES (ES 3.00 §4.3.8.2).
    fn check_output_locations(&mut self) {
        if self.stage != Stage::Fragment || !self.ast.version.is_es() {
            return;
        }
        let own = |global: &&Global| global.storage == Storage::Out && global.builtin.is_none();
        let outputs: Vec<&Global> = self.shader.globals.iter().filter(own).collect();
        let without = outputs.iter().find(|global| global.location.is_none());
        let (Some(without), 2..) = (without, outputs.len()) else { return };
        let message = format!("`{}` has no location, and it is one of several outputs", without.name);
        let mut finding = Diagnostic::new(&qualifiers::MISSING_LOCATION, without.span, message)
            .here("GLSL ES asks for a location of each")
            .help(format!("write `layout(location = n)` before `out` of all {} outputs", outputs.len()));
        if let Some(other) = outputs.iter().find(|other| other.span != without.span) {
            finding = finding.label(other.span, "another output");
        }
        self.report(finding);
    }

    /// Checks that a shader writes only one of `gl_ClipVertex` and `gl_ClipDistance` (GLSL 1.30 §7.1).
    fn check_clipping(&mut self) {
        let find = |is_it: &dyn Fn(&Global) -> bool| {
            self.shader.globals().find(|(_, global)| global.storage == Storage::Out && global.written && is_it(global))
        };
        let vertex = find(&|global| global.is_fixed() && global.name == "gl_ClipVertex");
        let distance = find(&|global| global.builtin == Some(BuiltinVariable::ClipDistance));
        let (Some((vertex, _)), Some((distance, _))) = (vertex, distance) else { return };
        let at = |id| self.uses.first(id).unwrap_or_default();
        let message = "`gl_ClipVertex` and `gl_ClipDistance` cannot both be written";
        let finding = Diagnostic::new(&qualifiers::OUTPUTS_EXCLUDE, at(distance), message)
            .here("the distances from planes of the shader's own")
            .label(at(vertex), "the position for the planes of the host")
            .help("write one of them: `gl_ClipDistance[i] = dot(plane, position)` is the newer way");
        self.report(finding);
    }
}
