//! Codes of the phase `syntax`; the table in the parent module says which range.

codes! {}
