//! Finds out whether the result of a shader depends on the order in which operands are evaluated.
//!
//! GLSL 1.50 defines the order for `,`, `&&`, `||` and `?:` (section 5.9) and for nothing else. The reference goes
//! from left to right; a driver need not.

use glisten_front::builtin::BuiltinFunction;
use glisten_front::hir::{ExprId, ExprKind, ParamMode, Shader, VarRef};

/// The variables that evaluating an expression reads and writes.
#[derive(Clone, Default)]
struct Effects {
    reads: Vec<VarRef>,
    writes: Vec<VarRef>,
    /// Whether it calls a function of the shader, which may access any global.
    calls: bool,
}

impl Effects {
    fn add(&mut self, other: &Self) {
        self.reads.extend_from_slice(&other.reads);
        self.writes.extend_from_slice(&other.writes);
        self.calls |= other.calls;
    }

    /// Whether it writes, or may write, something that the other accesses.
    fn disturbs(&self, other: &Self) -> bool {
        let touched = |var: &VarRef| other.reads.contains(var) || other.writes.contains(var);
        let mut all = other.reads.iter().chain(&other.writes);
        self.writes.iter().any(touched)
            || self.calls && (other.calls || all.any(|var| matches!(var, VarRef::Global(_))))
    }

    fn conflicts(&self, other: &Self) -> bool {
        self.disturbs(other) || other.disturbs(self)
    }
}

/// Whether some expression has operands of which one writes what another reads or writes.
pub(super) fn is_open(shader: &Shader) -> bool {
    // Children precede their parents.
    let mut known: Vec<Effects> = Vec::with_capacity(shader.exprs.len());
    for expr in &shader.exprs {
        let children = expr.kind.children();
        let ordered = matches!(expr.kind, ExprKind::Comma(..) | ExprKind::Logical(..) | ExprKind::Ternary(..));
        let mut operands: Vec<Effects> = children.iter().map(|child| known[child.index()].clone()).collect();
        let mut written: Vec<VarRef> = Vec::new();
        match &expr.kind {
            ExprKind::Assign(operation, target, _) => {
                // The target of an assignment is written last, and read only if there is an operation.
                if operation.is_none() {
                    forget(&mut operands[0], shader.root_variable(*target));
                }
                written.extend(shader.root_variable(*target));
            }
            ExprKind::IncDec(_, target) => written.extend(shader.root_variable(*target)),
            ExprKind::BuiltinCall(BuiltinFunction::Modf, arguments) => {
                written.extend(arguments.get(1).and_then(|whole| shader.root_variable(*whole)));
            }
            ExprKind::Call(function, arguments) => {
                let function = shader.function(*function);
                let goes_out = |(index, _): &(usize, &ExprId)| {
                    matches!(function.param_mode(*index), ParamMode::Out | ParamMode::Inout)
                };
                let out = arguments.iter().enumerate().filter(goes_out);
                written.extend(out.filter_map(|(_, argument)| shader.root_variable(*argument)));
            }
            _ => {}
        }
        let twice = |index: usize| operands[index + 1..].iter().any(|other| operands[index].conflicts(other));
        if !ordered && (0..operands.len()).any(twice) {
            return true;
        }
        let mut effects = Effects { calls: matches!(expr.kind, ExprKind::Call(..)), ..Effects::default() };
        operands.iter().for_each(|operand| effects.add(operand));
        effects.writes.extend(written);
        if let ExprKind::Var(var) = expr.kind {
            effects.reads.push(var);
        }
        known.push(effects);
    }
    false
}

/// Removes one read of a variable.
fn forget(effects: &mut Effects, root: Option<VarRef>) {
    if let Some(place) = effects.reads.iter().position(|var| Some(*var) == root) {
        effects.reads.swap_remove(place);
    }
}
