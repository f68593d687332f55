//! Rules over legal programs that will hurt, one file a rule. Reads and never changes.
