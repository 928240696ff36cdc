//! Points that a case keeps in a CSV file beside it: corners of a polygon, points of a terrain.

use std::path::Path;

use super::path::KeyPath;
use super::schema::{Case, MAX_POINTS};
use super::validate::Problem;

/// Longer files are no outlines, bytes.
const LONGEST: u64 = 1 << 20;

/// Puts the points of files in the place of their names; the files lie relative to `folder`, and a case without one may name none. Returns what
/// is wrong.
pub fn fill(case: &mut Case, folder: Option<&Path>) -> Vec<Problem> {
    let mut problems = Vec::new();
    let bodies = case.bodies.iter_mut().map(|b| (&mut b.polygon_m, &mut b.polygon_file)).enumerate();
    let bodies = bodies.map(|(k, own)| (KeyPath::top("bodies").index(k), ["polygon_m", "polygon_file"], own));
    let terrains = case.boundaries.iter_mut().map(|b| (&mut b.points_m, &mut b.points_file)).enumerate();
    let terrains = terrains.map(|(k, own)| (KeyPath::top("boundaries").index(k), ["points_m", "points_file"], own));
    for (at, [list, key], (points, file)) in bodies.chain(terrains) {
        let Some(name) = file.take() else { continue };
        let path = at.key(key);
        let mut refuse = |what: String, allowed: &str, fix: &str| {
            let value = toml::Value::from(name.as_str()).to_string();
            problems.push(Problem { path: path.clone(), what, value, allowed: allowed.into(), fix: fix.into() });
        };
        if points.is_some() {
            let what = format!("{path} and {list} are both given");
            refuse(what, "one of the two: they say the same thing", "remove one of the two");
            continue;
        }
        let Some(folder) = folder else {
            let what = format!("{path} = {:?} is not read here", name);
            let allowed = "files only in a case that is run by itself: a study would not see that they have changed";
            refuse(what, allowed, &format!("write the points into the case: {list} = [[X, Y], ...]"));
            continue;
        };
        match read(&folder.join(&name)) {
            Ok(found) => *points = Some(found),
            Err(what) => {
                let allowed =
                    format!("a CSV file with columns x_m and y_m, a row for each of at most {MAX_POINTS} points");
                refuse(format!("{path}: {what}"), &allowed, "give the name of such a file, relative to the case file");
            }
        }
    }
    problems
}

fn read(path: &Path) -> Result<Vec<[f64; 2]>, String> {
    let name = path.display();
    let length = std::fs::metadata(path).map_err(|e| format!("{name} cannot be read: {e}"))?.len();
    if length > LONGEST {
        return Err(format!("{name} is longer than {} MiB", LONGEST >> 20));
    }
    let text = std::fs::read_to_string(path).map_err(|e| format!("{name} cannot be read: {e}"))?;
    of_text(&text).map_err(|what| format!("{name}, {what}"))
}

/// The points of a CSV text: its first line names the columns. Empty lines and lines that begin with # say nothing; other columns than the two
/// are passed over.
fn of_text(text: &str) -> Result<Vec<[f64; 2]>, String> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty() && !l.trim_start().starts_with('#'));
    let cells = |line: &str| line.split(',').map(|c| c.trim().trim_matches('"').to_owned()).collect::<Vec<_>>();
    let header = lines.next().map(|(_, line)| cells(line)).unwrap_or_default();
    let column = |name: &str| match header.iter().filter(|c| *c == name).count() {
        1 => Ok(header.iter().position(|c| c == name).unwrap_or(0)),
        0 => Err(format!("line 1: no column `{name}`")),
        _ => Err(format!("line 1: more than one column `{name}`")),
    };
    let columns = [column("x_m")?, column("y_m")?];
    let mut points = Vec::new();
    for (number, line) in lines {
        let row = cells(line);
        if row.len() != header.len() {
            return Err(format!("line {}: {} cells where the header has {}", number + 1, row.len(), header.len()));
        }
        let mut point = [0.0; 2];
        for (d, k) in columns.into_iter().enumerate() {
            let value = row[k].parse::<f64>().ok().filter(|v| v.is_finite());
            point[d] = value.ok_or_else(|| format!("line {}: `{}` is no number", number + 1, row[k]))?;
        }
        points.push(point);
        if points.len() > MAX_POINTS {
            return Err(format!("more than {MAX_POINTS} points"));
        }
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::of_text;

    #[test]
    fn columns_are_found_by_their_names() {
        let text = "# surveyed\ny_m, z, \"x_m\"\n0.5,7,1.5\n\n-2e-1,8,3\n";
        assert_eq!(of_text(text), Ok(vec![[1.5, 0.5], [3.0, -0.2]]));
        assert_eq!(of_text("\u{feff}x_m,y_m\r\n1,2\r\n"), Ok(vec![[1.0, 2.0]]));
        for (text, wrong) in [
            ("", "no column `x_m`"),
            ("x_m,z\n1,2\n", "no column `y_m`"),
            ("x_m,y_m,x_m\n1,2,3\n", "more than one column `x_m`"),
            ("x_m,y_m\n1,2\n1;2\n", "line 3: 1 cells where the header has 2"),
            ("x_m,y_m\n1,high\n", "line 2: `high` is no number"),
            ("x_m,y_m\n1,nan\n", "line 2: `nan` is no number"),
        ] {
            let found = of_text(text).expect_err(text);
            assert!(found.contains(wrong), "{found}");
        }
        let many = "x_m,y_m\n".to_owned() + &"1,2\n".repeat(1001);
        assert!(of_text(&many).expect_err("too many").contains("more than 1000 points"));
    }
}
