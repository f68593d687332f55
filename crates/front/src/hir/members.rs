//! Which members of a struct the code that `main` reaches reads.
//!
//! *In:* a shader. *Out:* for a global that is a struct or an array of structs, the indices of the members in use.
//! *Holds:* a struct that is passed to a function counts as far as the function reads the parameter. A struct that is
//! copied to a variable, compared or returned counts as a whole. *Not done here:* whether a value can reach an output.

use super::{ExprId, ExprKind, FunctionId, GlobalId, ParamMode, Shader, VarRef};
use std::collections::BTreeSet;

/// Members of a struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MembersRead {
    /// These, by index; none if it is empty.
    Some(BTreeSet<u32>),
    /// All, or the value as a whole.
    All,
}

impl MembersRead {
    /// Whether the member is among them.
    pub fn contains(&self, member: u32) -> bool {
        match self {
            Self::Some(members) => members.contains(&member),
            Self::All => true,
        }
    }

    fn nothing() -> Self {
        Self::Some(BTreeSet::new())
    }

    fn add(&mut self, other: &Self) {
        match (&mut *self, other) {
            (Self::Some(members), Self::Some(more)) => members.extend(more),
            _ => *self = Self::All,
        }
    }
}

/// A variable, or a part of it: the outermost member, and the indices on the way.
struct Path {
    root: VarRef,
    member: Option<u32>,
    indices: Vec<ExprId>,
}

impl Shader {
    /// The members of a global that the code which `main` reaches reads.
    pub fn members_read(&self, global: GlobalId) -> MembersRead {
        let mut params: Vec<Vec<MembersRead>> =
            self.functions.iter().map(|function| vec![MembersRead::nothing(); function.param_count]).collect();
        let mut read = MembersRead::nothing();
        for id in self.main.map(|main| self.callees_first(main)).unwrap_or_default() {
            for (root, members) in self.parts_read(id, &params) {
                match root {
                    VarRef::Global(named) if named == global => read.add(&members),
                    VarRef::Local(local) => {
                        let known = params.get_mut(id.index()).and_then(|params| params.get_mut(local.index()));
                        known.into_iter().for_each(|known| known.add(&members));
                    }
                    VarRef::Global(_) => {}
                }
            }
        }
        read
    }

    /// The parts of variables that a function reads. `params` has what the functions that it calls read of theirs.
    fn parts_read(&self, id: FunctionId, params: &[Vec<MembersRead>]) -> Vec<(VarRef, MembersRead)> {
        let mut found = Vec::new();
        let mut pending = self.roots(self.function(id).body.as_deref().unwrap_or(&[]));
        while let Some(expr) = pending.pop() {
            if let Some(path) = self.path(expr) {
                let members = path.member.map_or(MembersRead::All, |member| MembersRead::Some([member].into()));
                found.push((path.root, members));
                pending.extend(path.indices);
                continue;
            }
            let ExprKind::Call(callee, arguments) = &self.expr(expr).kind else {
                pending.extend(self.expr(expr).kind.children());
                continue;
            };
            for (index, &argument) in arguments.iter().enumerate() {
                let passed_in = self.function(*callee).param_mode(index) == ParamMode::In;
                let read = params.get(callee.index()).and_then(|params| params.get(index));
                match (self.path(argument).filter(|path| passed_in && path.member.is_none()), read) {
                    (Some(path), Some(read)) => {
                        found.push((path.root, read.clone()));
                        pending.extend(path.indices);
                    }
                    _ => pending.push(argument),
                }
            }
        }
        found
    }

    /// The variable and the outermost member that an expression selects from; `None` for other values.
    fn path(&self, expr: ExprId) -> Option<Path> {
        let (mut at, mut member, mut indices) = (expr, None, Vec::new());
        loop {
            match &self.expr(at).kind {
                ExprKind::Var(root) => return Some(Path { root: *root, member, indices }),
                ExprKind::Member(inner, index) => (at, member) = (*inner, Some(*index)),
                ExprKind::Index(inner, index) => {
                    indices.push(*index);
                    at = *inner;
                }
                ExprKind::Swizzle(inner, _) => at = *inner,
                _ => return None,
            }
        }
    }
}
