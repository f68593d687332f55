//! The macro `commands!`: the commands from a table, which is in the module above.
//!
//! *In:* for each command its sentence, its name, the arguments of its module, and whether it hands code to a driver: `never`, `always`, or
//! `asked` (then its arguments tell). *Out:* `Command`, with its `run` and `draws_by_a_driver`, and `EXAMPLES`. *Holds:* a command is a file with `run`
//! and `EXAMPLES`, and a row. Its arguments have the sentence, too, for the command's own help: docs/commands.md, which a command checks, has both.

/// Declares the commands.
macro_rules! commands {
    (@draws never $arguments:ident) => {{
        let _ = $arguments;
        false
    }};
    (@draws always $arguments:ident) => {{
        let _ = $arguments;
        true
    }};
    (@draws asked $arguments:ident) => {
        $arguments.draws_by_a_driver()
    };
    ($(
        $(#[doc = $doc:literal])*
        $(#[cfg(feature = $feature:literal)])?
        $name:ident($module:ident::$arguments:ident) draws $draws:ident;
    )*) => {
        /// The commands. Only the arguments of the one that is asked for are set up.
        #[derive(Debug, Subcommand)]
        #[command(defer = true)]
        enum Command {
            $(
                $(#[doc = $doc])*
                $(#[cfg(feature = $feature)])?
                $name($module::$arguments),
            )*
        }

        impl Command {
            /// Whether the command hands code to a driver.
            fn draws_by_a_driver(&self) -> bool {
                match self {
                    $(
                        $(#[cfg(feature = $feature)])?
                        Self::$name(arguments) => commands!(@draws $draws arguments),
                    )*
                }
            }

            /// Runs the command.
            fn run(&self, console: &Console) -> Outcome {
                match self {
                    $(
                        $(#[cfg(feature = $feature)])?
                        Self::$name(arguments) => $module::run(arguments, console),
                    )*
                }
            }
        }

        /// The examples of each command, in their order.
        const EXAMPLES: &[examples::Examples] = &[
            $(
                $(#[cfg(feature = $feature)])?
                $module::EXAMPLES,
            )*
        ];
    };
}
