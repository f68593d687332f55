//! Codes of the phase `targets`; the table in the parent module says which range.

codes! {}
