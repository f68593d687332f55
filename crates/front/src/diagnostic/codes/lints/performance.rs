//! Lint rules of the group `performance`: work that need not be done, or not so often.

lints! {}
