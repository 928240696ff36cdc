//! Whether a value is valid by a JSON schema, by the keywords of draft 7 that the schemas of this program have.

use serde_json::{Map, Value};

/// Keywords that neither allow nor refuse anything.
const NOTES: [&str; 5] = ["$schema", "default", "definitions", "description", "title"];

/// What is not valid in a value at `path`, by a node of the schema `root`; nothing if all is.
///
/// # Panics
/// At a keyword that is not known here: it would count for nothing.
pub fn faults(root: &Value, node: &Value, value: &Value, path: &str) -> Vec<String> {
    match node {
        Value::Object(rules) => {
            // In draft 7 what stands beside a reference does not count.
            assert!(rules.len() == 1 || !rules.contains_key("$ref"), "{path}: rules beside a reference: {node}");
            rules.iter().flat_map(|(keyword, rule)| broken(root, rules, (keyword, rule), value, path)).collect()
        }
        Value::Bool(true) => Vec::new(),
        _ => vec![format!("{path} is not in the schema")],
    }
}

/// What one of the rules of a node refuses.
fn broken(root: &Value, rules: &Map<String, Value>, rule: (&str, &Value), value: &Value, path: &str) -> Vec<String> {
    let (keyword, rule) = rule;
    let below = |node: &Value, value: &Value, path: &str| faults(root, node, value, path);
    let unless = |holds: bool| if holds { Vec::new() } else { vec![format!("{path} = {value}: {keyword} {rule}")] };
    let limit = || rule.as_f64().unwrap_or_else(|| panic!("{path}: {keyword} {rule}"));
    match keyword {
        "$ref" => {
            let at = rule.as_str().and_then(|place| root.pointer(place.strip_prefix('#')?));
            below(at.unwrap_or_else(|| panic!("{path}: no definition {rule}")), value, path)
        }
        "allOf" => list(rule).iter().flat_map(|node| below(node, value, path)).collect(),
        "oneOf" => unless(list(rule).iter().filter(|node| below(node, value, path).is_empty()).count() == 1),
        "const" => unless(value == rule),
        "type" => unless(match rule {
            Value::Array(several) => several.iter().any(|one| is(one, value)),
            one => is(one, value),
        }),
        "minimum" => unless(value.as_f64().is_none_or(|number| number >= limit())),
        "minItems" => unless(value.as_array().is_none_or(|items| items.len() as f64 >= limit())),
        "maxItems" => unless(value.as_array().is_none_or(|items| items.len() as f64 <= limit())),
        "items" => {
            let items = value.as_array().into_iter().flatten().enumerate();
            items.flat_map(|(k, item)| below(rule, item, &format!("{path}.{k}"))).collect()
        }
        "required" => {
            let missing =
                |key: &&Value| value.as_object().is_some_and(|o| key.as_str().is_some_and(|k| o.get(k).is_none()));
            list(rule).iter().filter(missing).map(|key| format!("{path}: {key} is missing")).collect()
        }
        "properties" => {
            let known =
                value.as_object().into_iter().flatten().filter_map(|(key, value)| Some((key, rule.get(key)?, value)));
            known.flat_map(|(key, node, value)| below(node, value, &format!("{path}.{key}"))).collect()
        }
        "additionalProperties" => {
            let other = |key: &str| rules.get("properties").is_none_or(|known| known.get(key).is_none());
            let others = value.as_object().into_iter().flatten().filter(|(key, _)| other(key));
            others.flat_map(|(key, value)| below(rule, value, &format!("{path}.{key}"))).collect()
        }
        _ if NOTES.contains(&keyword) => Vec::new(),
        _ => panic!("{path}: the keyword {keyword} is not known here"),
    }
}

fn list(rule: &Value) -> &[Value] {
    rule.as_array().unwrap_or_else(|| panic!("no list: {rule}"))
}

/// Whether a value is of the type of this name.
fn is(name: &Value, value: &Value) -> bool {
    match name.as_str() {
        Some("boolean") => value.is_boolean(),
        Some("string") => value.is_string(),
        Some("number") => value.is_number(),
        Some("integer") => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        Some("array") => value.is_array(),
        Some("object") => value.is_object(),
        _ => panic!("the type {name} is not known here"),
    }
}

#[test]
fn each_keyword_refuses_what_it_should() {
    use serde_json::json;
    let table =
        json!({ "properties": { "a": { "type": "number" } }, "required": ["a"], "additionalProperties": false });
    let cases = [
        (json!({ "type": "integer", "minimum": 0 }), json!(4), json!(-4)),
        (json!({ "type": "integer" }), json!(4.0), json!(4.5)),
        (json!({ "type": ["string", "boolean"] }), json!(true), json!(1)),
        (json!({ "type": "array", "items": { "type": "string" } }), json!(["a"]), json!(["a", 1])),
        (json!({ "minItems": 2 }), json!([1, 2]), json!([1])),
        (json!({ "maxItems": 2 }), json!([1, 2]), json!([1, 2, 3])),
        (json!({ "oneOf": [{ "const": "a" }, { "const": "b" }] }), json!("b"), json!("c")),
        (json!({ "oneOf": [{ "minimum": 1 }, { "minimum": 2 }] }), json!(1), json!(3)),
        (json!({ "allOf": [{ "minimum": 1 }, { "type": "integer" }] }), json!(1), json!(1.5)),
        (table.clone(), json!({ "a": 1 }), json!({ "a": 1, "b": 1 })),
        (table.clone(), json!({ "a": 1 }), json!({})),
        (table.clone(), json!({ "a": 1 }), json!({ "a": "1" })),
        (json!({ "additionalProperties": { "type": "string" } }), json!({ "a": "b" }), json!({ "a": 1 })),
        (
            json!({ "definitions": { "x": table }, "allOf": [{ "$ref": "#/definitions/x" }] }),
            json!({ "a": 1 }),
            json!({}),
        ),
    ];
    for (schema, good, bad) in &cases {
        assert_eq!(faults(schema, schema, good, "file"), [""; 0], "{schema}");
        assert_eq!(faults(schema, schema, bad, "file").len(), 1, "{schema} of {bad}");
    }
    let (everything, nothing) = (json!(true), json!(false));
    assert_eq!(
        (faults(&everything, &everything, &json!(1), "").len(), faults(&nothing, &nothing, &json!(1), "").len()),
        (0, 1)
    );
}

#[test]
#[should_panic(expected = "the keyword pattern is not known here")]
fn a_keyword_that_is_not_known_does_not_pass() {
    let schema = serde_json::json!({ "pattern": "a" });
    let _ = faults(&schema, &schema, &Value::Null, "file");
}
