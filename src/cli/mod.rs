//! The command line, one file a subcommand. Only here is anything printed, read from the environment, or exited from.
