//! How long the functions of a shader are with all of their calls written out, as executors and drivers do that have no
//! calls.
//!
//! *In:* a [`Shader`]. *Out:* a number of expressions for each function. *Holds:* the number saturates: a chain of sixty
//! functions of which each calls the next one twice has more than 2^64.

use super::{FunctionId, Shader};

impl Shader {
    /// The number of expressions of each function, with those of the functions that it calls in place of each call.
    pub fn written_out(&self) -> Vec<u64> {
        let mut sizes = vec![0_u64; self.functions.len()];
        for id in self.callees_first_of(self.functions().map(|(id, _)| id)) {
            let size = self.own_size(id, &sizes);
            if let Some(slot) = sizes.get_mut(id.index()) {
                *slot = size;
            }
        }
        sizes
    }

    /// The number of expressions of `main`, with all calls written out.
    pub fn main_written_out(&self) -> u64 {
        let size = |main: FunctionId| self.written_out().get(main.index()).copied();
        self.main.and_then(size).unwrap_or(0)
    }

    fn own_size(&self, id: FunctionId, sizes: &[u64]) -> u64 {
        let mut size = 0_u64;
        if let Some(body) = &self.function(id).body {
            self.visit_body(body, &mut |expr| {
                let inside = match self.expr(expr).kind {
                    super::ExprKind::Call(callee, _) => sizes.get(callee.index()).copied().unwrap_or(0),
                    _ => 0,
                };
                size = size.saturating_add(1).saturating_add(inside);
            });
        }
        size
    }
}
