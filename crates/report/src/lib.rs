//! The report on training runs: the paper's tables and figures, made from run directories alone.
//!
//! | module | what it holds |
//! |---|---|
//! | [`run`] | run directories: `config.json`, `metrics.jsonl`, evaluations, heatmaps; recorded episodes |
//! | [`group`] | experiments: the runs that differ in their seed alone |
//! | [`statistics`], [`curve`] | intervals, inter-quartile means, curves over seeds |
//! | [`published`] | the values that the paper prints |
//! | [`document`], `sections` | what the report says |
//! | [`chart`], [`heat`] | figures and heatmaps |
//! | [`scoreboard`] | agents whose claims hold, as a page |
//! | [`report_page`] | the page alone, as text |
//! | [`write_report`] | HTML, Markdown, CSV, SVG, PNG and GIF files; LaTeX and PDF where wanted |
//!
//! Nothing here trains, plays or knows an environment, so that a report can be made of runs of any
//! version and on any machine. Same runs, same bytes.

// They panic where a stream is closed or its disk is full.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod chart;
mod csv;
pub mod curve;
pub mod document;
mod escape;
mod former;
pub mod group;
pub mod heat;
mod latex;
mod markdown;
mod page;
pub mod published;
pub mod run;
pub mod scoreboard;
mod sections;
pub mod site;
pub mod statistics;
mod write;

pub use page::{SCRIPT, base64};
pub use write::{Written, report_page, write_report, write_report_and_latex};
