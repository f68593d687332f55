//! Codes of the phase `types`; the table in the parent module says which range.

codes! {}
