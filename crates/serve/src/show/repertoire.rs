//! An agent's episodes at a glance: those of its run's closing evaluation, or some that are acted
//! out when they are asked for.

use super::performer::{Performer, performer};
use super::query::WatchQuery;
use super::rehearsal::Rehearsal;
use crate::answer::{aside, json_of, long_job, refusal};
use crate::asked::Asked;
use crate::shared::Shared;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Episodes that are acted out at most, and the time that may take.
const MOST_ACTED: u32 = 20;
const PATIENCE: Duration = Duration::from_secs(60);
/// Episodes of a file that are listed at most.
const MOST_LISTED: usize = 1000;
/// Largest file of closing episodes that is read.
const LARGEST_FILE: u64 = 16 << 20;

#[derive(Deserialize)]
pub(crate) struct Count {
    /// Episodes to act out where none are listed, from the seed of the address on.
    #[serde(default)]
    act: u32,
}

/// Seed, return and cost of each episode. Seeds are text: a page's numbers do not hold them all.
pub(crate) async fn episodes(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<WatchQuery>,
    Asked(count): Asked<Count>,
) -> Result<Response, Response> {
    query.check().map_err(|why| refusal(StatusCode::BAD_REQUEST, &why))?;
    if count.act > MOST_ACTED {
        let why = format!("act is at most {MOST_ACTED} episodes");
        return Err(refusal(StatusCode::BAD_REQUEST, &why));
    }
    let performer =
        performer(&shared, &query).await.map_err(|why| refusal(StatusCode::NOT_FOUND, &why))?;
    if count.act == 0 {
        let rows = aside(move || match &performer {
            Performer::Agent { run, .. } if query.env.is_empty() => listed(run),
            _ => Vec::new(),
        });
        return Ok(json_of(&json!({ "source": "closing", "rows": rows.await? })));
    }
    let places = Arc::clone(&shared.long_jobs);
    let acted = long_job(&places, move || act(&shared, query, &performer, count.act));
    let rows = acted.await?.map_err(|why| refusal(StatusCode::UNPROCESSABLE_ENTITY, &why))?;
    Ok(json_of(&json!({ "source": "acted", "rows": rows })))
}

/// The closing episodes that a run keeps.
fn listed(run: &Path) -> Vec<Value> {
    let path = run.join("closing_episodes.jsonl");
    let small = std::fs::symlink_metadata(&path)
        .is_ok_and(|data| data.is_file() && data.len() <= LARGEST_FILE);
    let text =
        if small { std::fs::read_to_string(path).unwrap_or_default() } else { String::new() };
    let row = |line: &str| {
        let line: Value = serde_json::from_str(line).ok()?;
        let seed = line["seed"].as_u64()?;
        Some(row(seed, line["return"].as_f64()?, line["cost"].as_f64()?, line["length"].as_u64()?))
    };
    text.lines().filter_map(row).take(MOST_LISTED).collect()
}

fn row(seed: u64, episode_return: f64, cost: f64, length: u64) -> Value {
    json!({ "seed": seed.to_string(), "return": episode_return, "cost": cost, "length": length })
}

/// Acts out episodes of seeds in a row.
fn act(
    shared: &Shared,
    mut query: WatchQuery,
    performer: &Performer,
    count: u32,
) -> Result<Vec<Value>, String> {
    if let Performer::Recorded(_) = performer {
        return Ok(Vec::new());
    }
    let begun = Instant::now();
    let mut rows = Vec::new();
    for _ in 0..count {
        let left = PATIENCE.saturating_sub(begun.elapsed());
        let mut rehearsal = Rehearsal::new(shared, &query, performer)?;
        rehearsal.go_on(left, usize::MAX);
        if !rehearsal.over() {
            break;
        }
        let (episode_return, cost) = rehearsal.sums();
        rows.push(row(query.seed, episode_return, cost, rehearsal.steps() as u64));
        query.seed = query.seed.wrapping_add(1);
    }
    Ok(rows)
}
