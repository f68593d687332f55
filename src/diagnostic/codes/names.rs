//! Codes of the phase `names`; the table in the parent module says which range.

codes! {}
