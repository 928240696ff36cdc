//! `checkdam completions` and `checkdam man`: what clap makes of the command line itself.

use super::console::{raw, tell};
use super::{BAD_INPUT, Cli, ENDED_EARLY};
use clap::CommandFactory;
use clap_complete::{Shell, generate};
use std::process::ExitCode;

/// Prints what a shell reads to complete commands, options and files.
pub fn completions(shell: Shell) -> ExitCode {
    let mut text = Vec::new();
    generate(shell, &mut Cli::command(), "checkdam", &mut text);
    raw(&text);
    ExitCode::SUCCESS
}

/// Prints the manual page of the program, or of one of its commands.
pub fn man(name: Option<&str>) -> ExitCode {
    let mut program = Cli::command();
    program.build();
    let command = match name {
        None => program,
        Some(name) => match program.find_subcommand(name) {
            Some(command) => command.clone(),
            None => {
                let known: Vec<_> = program.get_subcommands().map(clap::Command::get_name).collect();
                tell!("error: there is no command `{name}`; there are: {}", known.join(", "));
                return ExitCode::from(BAD_INPUT);
            }
        },
    };
    let mut text = Vec::new();
    if let Err(error) = clap_mangen::Man::new(command).render(&mut text) {
        tell!("error: the page cannot be made: {error}");
        return ExitCode::from(ENDED_EARLY);
    }
    raw(&text);
    ExitCode::SUCCESS
}
