//! Codes of the phase `lints`; the table in the parent module says which range.

codes! {}
