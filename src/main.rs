//! The command `sinew`.

mod command_line;

fn main() -> std::process::ExitCode {
    command_line::main()
}
