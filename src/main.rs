//! Arguments -> verb -> exit code.

mod cli;

use clap::Parser;
use cli::{Cli, Verb};
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return cli::usage(error),
    };
    let done = match cli.verb {
        Verb::Run(args) => cli::run::run(&args),
        Verb::Compare(args) => cli::compare::compare(&args),
        Verb::Sensitivity(args) => cli::sensitivity::sensitivity(&args),
        Verb::Pst(args) => cli::pst::pst(&args),
        Verb::Ghosts(args) => cli::ghosts::ghosts(&args),
        Verb::Glare(args) => cli::glare::glare(&args),
        Verb::Check(args) => cli::check::check(&args),
        Verb::Ray(args) => cli::ray::ray(&args),
        Verb::Bsdf(args) => cli::bsdf::bsdf(&args),
        Verb::Export(args) => cli::export::export(&args),
        Verb::Import(args) => cli::import::import(&args),
        Verb::Fit(args) => cli::fit::fit(&args),
        Verb::FitBsdf(args) => cli::fit_bsdf::fit_bsdf(&args),
        Verb::Coating(args) => cli::coating::coating(&args),
        Verb::Finishes => cli::finishes::finishes(),
        Verb::Schema => cli::schema::schema(),
    };
    cli::conclude(done)
}
