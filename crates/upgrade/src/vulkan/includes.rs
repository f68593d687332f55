//! [`Includes`]: the files that the includes of programs name, as their compilers find them.
//!
//! *In:* compilers. *Out:* for each including file and path the file that was found, after the compilers have run.

use glisten_front::compiler::{Compiler, Prepared};
use glisten_front::source::{IncludeForm, IncludeResolver, Included};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A file that includes, and the path that it names.
pub(super) type Named = (String, String);

/// The includes of programs. Copies share what was found.
#[derive(Clone, Default)]
pub struct Includes(Arc<Mutex<BTreeMap<Named, Included>>>);

impl Includes {
    /// A compiler that notes what includes name.
    pub fn noted(&self, compiler: &Compiler) -> Compiler {
        let (noted, own) = (self.clone(), compiler.includes());
        compiler.clone().with_change(move |_, prepared| {
            let inner = prepared.includes.clone().unwrap_or_else(|| Arc::clone(&own));
            Prepared { includes: Some(Arc::new(Recorder { inner, noted: noted.clone() })), ..prepared }
        })
    }

    /// Each include of the compilers that have run, with the file that was found.
    pub fn all(&self) -> BTreeMap<Named, Included> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

struct Recorder {
    inner: Arc<dyn IncludeResolver + Send + Sync>,
    noted: Includes,
}

impl IncludeResolver for Recorder {
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        let found = self.inner.resolve(path, form, from)?;
        let mut noted = self.noted.0.lock().unwrap_or_else(PoisonError::into_inner);
        noted.insert((from.to_owned(), path.to_owned()), found.clone());
        Ok(found)
    }
}
