//! Writers of diagnostics, one file a format. They know nothing of rules.
