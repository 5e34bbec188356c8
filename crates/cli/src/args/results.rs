//! Flags of the commands that publish: reports, the page, claims.

use crate::args::common::{Rules, UnusedSeed};
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;

/// `hasard report`.
#[derive(Args, Debug)]
pub struct ReportArgs {
    /// Run directories or folders that hold them, .episode files, and .jsonl files of `hasard
    /// rollout --json`
    #[arg(required = true)]
    pub runs: Vec<PathBuf>,
    /// Folder to write: a new or an empty one, or that of an earlier report, which goes
    #[arg(short, long, value_name = "DIR", default_value = "report")]
    pub out: PathBuf,
    /// Title of the page
    #[arg(long, default_value = "HASARD results")]
    pub title: String,
    /// For a paper too: tables.tex (booktabs), a document around it, and every chart as PDF
    #[arg(long)]
    pub latex: bool,
    /// One JSON object about what was written
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard site`.
#[derive(Args, Debug)]
pub struct SiteArgs {
    /// Films to show beside those of the clone: .mp4 and .gif
    #[arg(value_name = "FILM")]
    pub films: Vec<PathBuf>,
    /// Folder to write to
    #[arg(short, long, value_name = "DIR", default_value = "site")]
    pub out: PathBuf,
    /// The clone of the repository
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub root: PathBuf,
    /// One JSON object about what was written
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// An address and a port; a name such as localhost is looked up, IPv4 first.
fn listening(text: &str) -> Result<std::net::SocketAddr, String> {
    use std::net::ToSocketAddrs;
    let wrong = |why: String| format!("{why}; give an address and a port, such as 127.0.0.1:8350");
    let found: Vec<_> = text.to_socket_addrs().map_err(|why| wrong(why.to_string()))?.collect();
    let first = found.iter().find(|one| one.is_ipv4()).or(found.first());
    first.copied().ok_or_else(|| wrong("it has no address".into()))
}

/// `hasard serve`.
#[derive(Args, Debug)]
pub struct ServeArgs {
    /// Folders below which runs are looked for, while they run too; `runs` if absent. Files of own
    /// tasks, which can be watched and played
    #[arg(value_name = "RUNS")]
    pub runs: Vec<PathBuf>,
    /// Address to listen at; beyond this machine only with the token that is printed
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8350", value_parser = listening)]
    pub listen: std::net::SocketAddr,
    /// What visitors must know; drawn anew if absent and --listen goes beyond this machine
    #[arg(long, value_name = "TEXT")]
    pub token: Option<String>,
    /// Folder in which episodes that are played are kept
    #[arg(long, value_name = "DIR", default_value = "human")]
    pub out: PathBuf,
    /// Open the page in the browser
    #[arg(long)]
    pub open: bool,
    /// Let visitors write notes and tags of runs, archive them, and move them to the folder .trash
    #[arg(long)]
    pub edit: bool,
    /// Where maps are now that runs were trained in and that are no longer there
    #[arg(long, value_name = "DIR")]
    pub maps: Option<PathBuf>,
    /// Where the IWAD is now that runs were trained with and that is no longer there
    #[arg(long, value_name = "FILE")]
    pub iwad: Option<PathBuf>,
}

/// `hasard claim`.
#[derive(Args, Debug)]
pub struct ClaimArgs {
    /// Run directory, agent file, or zoo:NAME for an agent that comes with the program
    #[arg(value_name = "RUN|FILE|zoo:NAME")]
    pub agent: OsString,
    /// Name of the agent on a scoreboard
    #[arg(long, default_value = "hasard")]
    pub name: String,
    /// The rule set of the claim  [default: the run's]
    #[arg(long, value_enum)]
    pub rules: Option<Rules>,
    /// Number of episodes; scoreboards list claims of 200, 1,000 or 10,000 alone
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub episodes: u32,
    /// The command that trained the agent  [default: from the run's settings]
    #[arg(long, value_name = "COMMAND")]
    pub how: Option<String>,
    /// Folder that claim and agent are written to
    #[arg(short, long, value_name = "DIR", default_value = "scoreboard")]
    pub out: PathBuf,
    /// One JSON object about the claim
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard verify`.
#[derive(Args, Debug)]
pub struct VerifyArgs {
    /// A claim (.claim.json), its agent beside it; or a folder of claims
    #[arg(value_name = "CLAIM")]
    pub claim: PathBuf,
    /// Number of threads; what is found does not depend on it  [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// One JSON object a claim
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard scoreboard`.
#[derive(Args, Debug)]
pub struct ScoreboardArgs {
    /// Folder of claims and their agents; the page becomes its index.html
    pub folder: PathBuf,
    /// Title of the page
    #[arg(long, default_value = "HASARD scoreboard")]
    pub title: String,
    /// One JSON object about the page
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}
