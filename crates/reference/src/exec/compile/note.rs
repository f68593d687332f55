//! Notes of values, in the forms that have them ([`Form::notes`](super::super::code::Form)).
//!
//! *In:* values as they are compiled. *Out:* a [`Note`] and an instruction that shows it. *Not done here:* literals, and
//! conversions that the text does not write, are not noted.

use super::super::inst::{Class, Inst, Operand};
use super::super::note::{Note, NoteKind};
use super::Compiler;
use glisten_front::hir::{Expr, ExprId, ExprKind, Function, GlobalId, Local, Storage, TypeId, VarRef};
use glisten_front::source::Span;

impl Compiler<'_> {
    fn note(&mut self, kind: NoteKind, span: Span, name: &str, ty: TypeId, value: &[Operand]) {
        if !self.emit.form.notes() {
            return;
        }
        let mut scalars = Vec::new();
        if !value.is_empty() {
            super::flatten(self.types, ty, &mut scalars);
        }
        let of_class = |class: Class| -> Vec<Operand> {
            let typed = scalars.iter().zip(value).filter(|(scalar, _)| Class::of(**scalar) == class);
            typed.map(|(_, operand)| *operand).collect()
        };
        let [floats, ints] = [Class::Float, Class::Int].map(|class| self.emit.list(class, &of_class(class), false));
        let number = self.emit.notes.len() as u32;
        self.emit.notes.push(Note { kind, span, name: name.to_owned(), ty, scalars });
        self.at(span, |this| this.emit.push(Inst::Note { note: number, floats, ints }));
    }

    /// Notes the value of an expression.
    pub(super) fn note_expr(&mut self, expr: &Expr, value: &[Operand]) {
        let kind = match &expr.kind {
            ExprKind::Error | ExprKind::Literal(_) | ExprKind::Comma(..) => return,
            ExprKind::Unary(_, inner) if matches!(self.shader.expr(*inner).kind, ExprKind::Literal(_)) => return,
            ExprKind::Convert(inner) if self.shader.expr(*inner).span == expr.span => return,
            ExprKind::Var(_) | ExprKind::Member(..) | ExprKind::Index(..) | ExprKind::Swizzle(..) => NoteKind::Read,
            _ => NoteKind::Value,
        };
        if !value.is_empty() {
            self.note(kind, expr.span, "", expr.ty, value);
        }
    }

    /// Notes a variable with its first value.
    pub(super) fn note_local(&mut self, local: &Local, value: &[Operand]) {
        if value.is_empty() || local.name.is_empty() {
            return;
        }
        self.note(NoteKind::Local, local.span, &local.name, local.ty, value);
    }

    /// Notes the value of a variable that was incremented or decremented.
    pub(super) fn note_stepped(&mut self, place: ExprId, value: &[Operand]) {
        let expr = self.shader.expr(place);
        let name = match expr.kind {
            ExprKind::Var(VarRef::Global(id)) => self.shader.globals.get(id.index()).map(|global| &global.name),
            ExprKind::Var(VarRef::Local(id)) => {
                let function = self.frames.last().map(|frame| self.shader.function(frame.function));
                function.and_then(|function| function.locals.get(id.index())).map(|local| &local.name)
            }
            _ => None,
        };
        if let Some(name) = name {
            self.note(NoteKind::Local, expr.span, name, expr.ty, value);
        }
    }

    /// Notes the scalar that decides which way lanes take.
    pub(super) fn note_branch(&mut self, kind: NoteKind, condition: ExprId, value: Operand) {
        let (span, ty) = (self.shader.expr(condition).span, self.ty(condition));
        self.note(kind, span, "", ty, &[value]);
    }

    /// Notes that a function begins, and its parameters; that of an `out` parameter has no value yet.
    pub(super) fn note_call(&mut self, callee: &Function, span: Span, arguments: &[super::Val]) {
        if self.frames.len() > 1 && self.emit.form.notes() {
            self.note(NoteKind::Call, span, &callee.name, TypeId::VOID, &[]);
            for (param, value) in callee.params().iter().zip(arguments) {
                self.note_local(param, value);
            }
        }
    }

    /// Notes that a function has returned.
    pub(super) fn note_return(&mut self, callee: &Function, span: Span, value: &[Operand]) {
        if self.frames.len() > 1 {
            self.note(NoteKind::Return, span, &callee.name, callee.ret, value);
        }
    }

    /// Notes a `discard`.
    pub(super) fn note_discard(&mut self) {
        let span = self.emit.span;
        self.note(NoteKind::Discard, span, "", TypeId::VOID, &[]);
    }

    /// Notes the inputs that the stage uses, or the outputs that it writes.
    pub(super) fn note_globals(&mut self, storage: Storage) {
        if !self.emit.form.notes() {
            return;
        }
        let kind = if storage == Storage::In { NoteKind::Input } else { NoteKind::Output };
        let shader = self.shader;
        for (id, global) in shader.globals() {
            let is_meant =
                global.storage == storage && if storage == Storage::In { global.used } else { global.written };
            if let Some(var) = Some(id).filter(|_| is_meant).and_then(|id: GlobalId| self.global_var(id)) {
                let value = self.read_all(var);
                self.note(kind, global.span, &global.name, global.ty, &value);
            }
        }
    }
}
