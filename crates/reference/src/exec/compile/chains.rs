//! Chains of sums or products with several constants, which a compiler may combine before anything runs.
//!
//! *In:* the operands of `+`, `-`, `*` and `/`. *Out:* the result of the operation as written; and, from the second
//! constant of a chain on, an instruction that lets an envelope have the result with all constants combined as well:
//! `(x * 1e30) * 1e30` may be `x * inf`, `(x - 3e38) - 3e38` may be `x - inf`. A `step` has the constant 1 in it.
//!
//! *Holds:* Vulkan (Precision and Operation: Evaluation of Expressions) and WGSL (Reassociation and Fusion) allow it, and
//! drivers do it. Values are those of the text. *Not done here:* chains whose terms include the negative of a variable.

use super::super::code::PoolSource;
use super::super::inst::{Class, Float2, Inst, Operand};
use super::Compiler;
use super::emit::Emitter;
use super::facts::{Chain, Definition, MAX_TERMS};
use smallvec::SmallVec;

impl Emitter {
    /// The value of a float operand that the text knows.
    fn known_float(&self, operand: Operand) -> Option<f64> {
        if operand.is_reg() || operand.is_preamble() {
            return None;
        }
        match self.pools[Class::Float as usize].get(operand.number()) {
            Some(PoolSource::Constant(bits)) => Some(f64::from(f32::from_bits(*bits))),
            _ => None,
        }
    }

    /// An operand as a chain of the kind.
    fn chain_of(&self, operand: Operand, sum: bool) -> Chain {
        let blank = Chain {
            sum,
            terms: SmallVec::new(),
            constant: if sum { 0.0 } else { 1.0 },
            constants: 0,
            prefixes: SmallVec::new(),
            stores: None,
        };
        if let Some(value) = self.known_float(operand) {
            return Chain { constant: value, constants: 1, ..blank };
        }
        let known = self.chains.get(&operand).filter(|chain| chain.sum == sum);
        if let Some(chain) = known.filter(|chain| chain.stores.is_none_or(|stores| stores == self.stores)) {
            return chain.clone();
        }
        let stores = self.is_home(Class::Float, operand).then_some(self.stores);
        Chain { terms: SmallVec::from_slice(&[operand]), stores, ..blank }
    }

    /// The chain that an operation makes or continues.
    fn chain(&self, op: Float2, a: Operand, b: Operand) -> Option<Chain> {
        let sum = match op {
            Float2::Add | Float2::Sub => true,
            Float2::Mul | Float2::Div => false,
            _ => return None,
        };
        let (mut chain, mut other) = (self.chain_of(a, sum), self.chain_of(b, sum));
        if matches!(op, Float2::Sub | Float2::Div) {
            if !other.terms.is_empty() {
                return None;
            }
            other.constant = if sum { -other.constant } else { 1.0 / other.constant };
        }
        let combined = |x: f64, y: f64| if sum { x + y } else { x * y };
        let (result, added) = match (chain.terms.is_empty(), other.terms.is_empty()) {
            (false, true) => (Some(a), other.constant),
            (true, false) => {
                chain.prefixes = std::mem::take(&mut other.prefixes);
                (Some(b), chain.constant)
            }
            _ => (None, 0.0),
        };
        match result {
            Some(result) => {
                chain.prefixes.iter_mut().for_each(|(_, constant)| *constant = combined(*constant, added));
                chain.prefixes.push((result, added));
                // The latest ones.
                chain.prefixes.drain(..chain.prefixes.len().saturating_sub(MAX_TERMS));
            }
            None => chain.prefixes.clear(),
        }
        chain.constant = combined(chain.constant, other.constant);
        chain.constants += other.constants;
        chain.stores = chain.stores.or(other.stores);
        chain.terms.extend(other.terms);
        (!chain.terms.is_empty() && chain.terms.len() <= MAX_TERMS && chain.constants > 0).then_some(chain)
    }
}

impl Compiler<'_> {
    /// `a op b`, and where constants may be combined, the same with them combined.
    pub(super) fn chained(&mut self, op: Float2, a: Operand, b: Operand) -> Operand {
        let plain = self.float2(op, a, b);
        if !self.emit.form.rewrites() {
            return plain;
        }
        let Some(chain) = self.emit.chain(op, a, b) else { return plain };
        let mut result = plain;
        if chain.constants > 1 {
            result = self.folded(result, chain.sum, &chain.terms, chain.constant);
            // Some constants may be combined, and not others: those after an earlier result. The last one is as written.
            let (_, earlier) = chain.prefixes.split_last().unwrap_or((&(plain, 0.0), &[]));
            for (prefix, constant) in earlier.iter().filter(|(prefix, _)| chain.terms[..] != [*prefix]) {
                result = self.folded(result, chain.sum, &[*prefix], *constant);
            }
        }
        self.emit.chains.insert(result, chain);
        result
    }

    /// Takes 0 or 1 for `1 - b`, which is how compilers write the negation of a condition as a number: `step(0.5, x) + 0.02` may be
    /// `1.02 - b`, and lose digits that neither 0 nor 1 has.
    pub(super) fn of_one_less(&mut self, number: Operand) {
        if !self.emit.form.rewrites() {
            return;
        }
        let one = self.emit.float(1.0);
        let less = self.emit.pure(Class::Float, &[number, one], |dst| Inst::Float2 {
            op: Float2::Sub,
            dst,
            a: number,
            b: one,
        });
        let (terms, prefixes) = (SmallVec::from_slice(&[less]), SmallVec::new());
        let chain = Chain { sum: true, terms, constant: 1.0, constants: 1, prefixes, stores: None };
        self.emit.chains.insert(number, chain);
    }

    fn folded(&mut self, plain: Operand, sum: bool, terms: &[Operand], constant: f64) -> Operand {
        let constant = self.emit.float(constant as f32);
        let operands: Vec<Operand> = terms.iter().copied().chain([constant]).collect();
        let hoisted = plain.is_scalar();
        let list = self.emit.list(Class::Float, &operands, hoisted);
        let both = self.emit.pure(Class::Float, &[plain], |dst| Inst::Folded { sum, dst, a: plain, list });
        self.emit.define(both, Definition::Same(plain));
        both
    }
}
