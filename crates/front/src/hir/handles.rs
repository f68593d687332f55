//! The handles of globals, functions and locals: indices into their arenas.

macro_rules! handle {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(u32);

        impl $name {
            /// The handle of the element `index` of its arena.
            pub fn new(index: usize) -> Self {
                Self(index as u32)
            }

            /// The index in its arena.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

handle!(
    /// The handle of a global in a [`Shader`](super::Shader).
    GlobalId
);
handle!(
    /// The handle of a function in a [`Shader`](super::Shader).
    FunctionId
);
handle!(
    /// The handle of a local in a [`Function`](super::Function).
    LocalId
);
