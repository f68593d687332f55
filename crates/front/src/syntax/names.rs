//! [`Names`]: the spellings of a tree.
//!
//! *Holds:* equal spellings have equal symbols. The words of the [keyword table](super::keywords) come first in
//! [`Names::with_keywords`], in the table's order.

use super::keywords;
use super::token::Symbol;
use std::hash::Hasher;
use std::sync::LazyLock;

/// The spellings of [`Symbol`]s: one text for all, and an open-addressing hash table over it, so that a copy of the
/// prepared keywords is three plain copies of memory.
#[derive(Clone, Debug, Default)]
pub struct Names {
    text: String,
    /// The end of each spelling in the text, and its hash.
    entries: Vec<(u32, u32)>,
    /// The slots of the hash table, a power of two of them: symbol + 1, or 0.
    slots: Vec<u32>,
}

static KEYWORDS: LazyLock<Names> = LazyLock::new(|| {
    let mut names = Names::default();
    for row in keywords::TABLE {
        names.intern(row.spelling);
    }
    names
});

impl Names {
    /// Names that begin with the words of the keyword table, so that symbol *n* is row *n*.
    pub fn with_keywords() -> Self {
        KEYWORDS.clone()
    }

    /// The symbol of a spelling.
    pub fn intern(&mut self, name: &str) -> Symbol {
        if (self.entries.len() + 1) * 2 > self.slots.len() {
            self.grow();
        }
        let hash = hash(name);
        match self.probe(name, hash) {
            Ok(symbol) => symbol,
            Err(slot) => {
                self.text.push_str(name);
                self.entries.push((self.text.len() as u32, hash));
                if let Some(place) = self.slots.get_mut(slot) {
                    *place = self.entries.len() as u32;
                }
                Symbol(self.entries.len() as u32 - 1)
            }
        }
    }

    /// The symbol of a spelling, if it has occurred.
    pub fn get(&self, name: &str) -> Option<Symbol> {
        if self.slots.is_empty() { None } else { self.probe(name, hash(name)).ok() }
    }

    /// The spelling of a symbol.
    pub fn spelling(&self, symbol: Symbol) -> &str {
        let index = symbol.index();
        let start = index.checked_sub(1).and_then(|before| self.entries.get(before)).map_or(0, |entry| entry.0);
        let end = self.entries.get(index).map_or(start, |entry| entry.0);
        self.text.get(start as usize..end as usize).unwrap_or("")
    }

    /// The number of names.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The symbol, or the empty slot where it belongs. The table must be neither empty nor full.
    fn probe(&self, name: &str, hash: u32) -> Result<Symbol, usize> {
        let mask = self.slots.len() - 1;
        let mut slot = hash as usize & mask;
        loop {
            let Some(number) = self.slots.get(slot).copied().filter(|&number| number != 0) else { return Err(slot) };
            let symbol = Symbol(number - 1);
            if self.entries.get(symbol.index()).is_some_and(|entry| entry.1 == hash) && self.spelling(symbol) == name {
                return Ok(symbol);
            }
            slot = (slot + 1) & mask;
        }
    }

    fn grow(&mut self) {
        let places = (self.slots.len() * 2).max(64);
        let mut slots = vec![0; places];
        for (index, (_, hash)) in self.entries.iter().enumerate() {
            let mut slot = *hash as usize & (places - 1);
            while slots.get(slot).is_some_and(|&number| number != 0) {
                slot = (slot + 1) & (places - 1);
            }
            if let Some(place) = slots.get_mut(slot) {
                *place = index as u32 + 1;
            }
        }
        self.slots = slots;
    }
}

fn hash(name: &str) -> u32 {
    let mut hasher = rustc_hash::FxHasher::default();
    hasher.write(name.as_bytes());
    let hash = hasher.finish();
    (hash ^ (hash >> 32)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_spellings_have_equal_symbols() {
        let mut names = Names::with_keywords();
        let before = names.len();
        let symbols: Vec<_> = (0..1000).map(|n| names.intern(&format!("name{n}"))).collect();
        assert_eq!(names.len(), before + 1000);
        for (n, symbol) in symbols.into_iter().enumerate() {
            assert_eq!(names.spelling(symbol), format!("name{n}"));
            assert_eq!(names.intern(&format!("name{n}")), symbol);
            assert_eq!(names.get(&format!("name{n}")), Some(symbol));
        }
        assert_eq!(names.get("absent"), None);
        assert_eq!(Names::default().get("absent"), None);
    }
}
