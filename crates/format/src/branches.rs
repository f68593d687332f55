//! [`Branches`]: the states at the conditions that are open.
//!
//! *In:* directives, and a state that lexemes change. *Out:* the state after a directive. *Holds:* each branch of an `#if` begins with
//! the state at the `#if`, and the text after `#endif` with the one at the end of the first branch (GLSL 1.50 §3.3).

/// The state at each open `#if`, and at the end of its first branch.
#[derive(Debug, Default)]
pub(super) struct Branches<S>(Vec<(S, Option<S>)>);

impl<S: Clone + Default> Branches<S> {
    /// How many conditions are open.
    pub(super) fn depth(&self) -> usize {
        self.0.len()
    }

    /// Changes the state as a directive does. Without `is_kept`, the state at an `#if` is forgotten.
    pub(super) fn pass(&mut self, directive: &str, state: &mut S, is_kept: bool) {
        let name = directive.get(1..).unwrap_or("").trim_start();
        if name.starts_with("if") {
            self.0.push((if is_kept { state.clone() } else { S::default() }, None));
        } else if name.starts_with("el") {
            if let Some((first, end)) = self.0.last_mut() {
                let here = std::mem::replace(state, first.clone());
                end.get_or_insert(here);
            }
        } else if name.starts_with("endif")
            && let Some((_, Some(end))) = self.0.pop()
        {
            *state = end;
        }
    }
}
