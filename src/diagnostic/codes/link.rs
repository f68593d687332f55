//! Codes of the phase `link`; the table in the parent module says which range.

codes! {}
