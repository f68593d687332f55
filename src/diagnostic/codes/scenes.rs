//! Codes of the phase `scenes`; the table in the parent module says which range.

codes! {}
