//! The `glisten` program: hands over to the command line.

fn main() {}
