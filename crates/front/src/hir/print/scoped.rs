//! Names of locals by their scopes: a name is given again where the scopes do not meet, and may hide a global that the function
//! does not mention.
//!
//! *In:* a function and the names of everything global. *Out:* the name of each local.

use super::names::NameTable;
use crate::hir::{ExprKind, Function, LocalId, LocalKind, Shader, Stmt, StmtKind, Types, VarRef};
use rustc_hash::{FxHashMap, FxHashSet};

/// Where locals are declared.
#[derive(Default)]
struct Scopes {
    /// The scope around each scope.
    parents: Vec<usize>,
    /// The scopes that declare a local.
    of: FxHashMap<LocalId, Vec<usize>>,
}

impl Scopes {
    fn push(&mut self, parent: usize) -> usize {
        self.parents.push(parent);
        self.parents.len() - 1
    }

    fn body(&mut self, body: &[Stmt], scope: usize) {
        for stmt in body {
            if let StmtKind::Local(local, _) = stmt.kind {
                self.of.entry(local).or_default().push(scope);
            }
            let condition = match &stmt.kind {
                StmtKind::Loop { condition: Some(condition), .. } => condition.local,
                _ => None,
            };
            let around = if condition.is_some() { self.push(scope) } else { scope };
            if let Some(local) = condition {
                self.of.entry(local).or_default().push(around);
            }
            let shared = matches!(stmt.kind, StmtKind::Switch { .. }).then(|| self.push(around));
            for inner in stmt.kind.bodies() {
                // All cases of a switch are one scope.
                let scope = shared.unwrap_or_else(|| self.push(around));
                self.body(inner, scope);
            }
        }
    }

    /// Whether one scope is the other or is around it.
    fn meet(&self, a: usize, b: usize) -> bool {
        let around = |mut inner: usize, outer: usize| {
            // Scopes around another have smaller numbers.
            while inner > outer {
                inner = self.parents.get(inner).copied().unwrap_or(0);
            }
            inner == outer
        };
        around(a.max(b), a.min(b))
    }
}

/// The name of each local of a function.
pub(super) fn local_names(table: &NameTable, types: &Types, shader: &Shader, function: &Function) -> Vec<String> {
    let mut scopes = Scopes { parents: vec![0], of: FxHashMap::default() };
    let body = function.body.as_deref().unwrap_or(&[]);
    scopes.body(body, 0);
    let taken = mentioned(table, types, shader, function, body);
    let mut given: FxHashMap<String, Vec<Vec<usize>>> = FxHashMap::default();
    let mut names = Vec::with_capacity(function.locals.len());
    for (index, local) in function.locals.iter().enumerate() {
        if local.name.is_empty() {
            names.push(String::new());
            continue;
        }
        let own = match local.kind {
            LocalKind::Param(_) => vec![0],
            _ => scopes.of.get(&LocalId::new(index)).cloned().unwrap_or_else(|| vec![0]),
        };
        let mut number = 1;
        let name = loop {
            let name = if number == 1 { local.name.clone() } else { format!("{}_{number}", local.name) };
            let others = given.get(&name).map_or(&[][..], Vec::as_slice);
            let meets = others.iter().flatten().any(|other| own.iter().any(|own| scopes.meet(*own, *other)));
            if !meets && !taken.contains(&name) {
                break name;
            }
            number += 1;
        };
        given.entry(name.clone()).or_default().push(own);
        names.push(name);
    }
    names
}

/// The global names that a function uses.
fn mentioned(
    table: &NameTable,
    types: &Types,
    shader: &Shader,
    function: &Function,
    body: &[Stmt],
) -> FxHashSet<String> {
    let mut taken: FxHashSet<String> = table.structs().iter().map(|id| table.structure(*id).to_owned()).collect();
    taken.insert(function.name.clone());
    shader.visit_body(body, &mut |id| {
        let expr = shader.expr(id);
        match &expr.kind {
            ExprKind::Var(VarRef::Global(global)) => {
                taken.insert(table.global(*global).to_owned());
                taken.insert(shader.global(*global).name.clone());
            }
            ExprKind::Member(base, _) => {
                // Members of a block without an instance name are names of their own.
                if let ExprKind::Var(VarRef::Global(global)) = shader.expr(*base).kind
                    && table.global(global).is_empty()
                {
                    taken.extend(super::names::members(types, shader.global(global).ty));
                }
            }
            ExprKind::Call(callee, _) => {
                taken.insert(table.function(*callee).to_owned());
            }
            ExprKind::BuiltinCall(function, _) => {
                taken.insert(function.name().to_owned());
                let rows = crate::builtin::functions::all().filter(|row| row.function == *function);
                taken.extend(rows.map(|row| row.name.to_owned()));
            }
            _ => {}
        }
    });
    taken
}
