#!/usr/bin/env python3
"""Finds what is wrong with an OpenAPI 3.1 document: what a generator of clients stumbles over, examples that do not fit
their schema, references that lead nowhere. The document must be whole by itself: nothing is fetched.

usage: openapi_lint.py DOCUMENT        prints the faults; exit status 1 where there is one
       openapi_lint.py --self-test DOCUMENT   breaks the document in every way that is looked for, and expects a fault
"""
import copy
import json
import pathlib
import re
import sys
import warnings

import jsonschema

# Debian 12 has jsonschema 4.10, whose only way to resolve references is out of use in later ones.
warnings.filterwarnings("ignore", category=DeprecationWarning)

METHODS = {"get", "put", "post", "delete", "options", "head", "patch", "trace"}
# The fixed fields of the objects [OpenAPI Specification 3.1.0, section 4.8].
FIELDS = {
    "document": {"openapi", "info", "jsonSchemaDialect", "servers", "paths", "webhooks", "components", "security", "tags", "externalDocs"},
    "info": {"title", "summary", "description", "termsOfService", "contact", "license", "version"},
    "path": METHODS | {"$ref", "summary", "description", "servers", "parameters"},
    "operation": {"tags", "summary", "description", "externalDocs", "operationId", "parameters", "requestBody", "responses",
                  "callbacks", "deprecated", "security", "servers"},
    "parameter": {"name", "in", "description", "required", "deprecated", "allowEmptyValue", "style", "explode", "allowReserved",
                  "schema", "example", "examples", "content"},
    "request body": {"description", "content", "required"},
    "response": {"description", "headers", "content", "links"},
    "header": {"description", "required", "deprecated", "style", "explode", "schema", "example", "examples", "content"},
    "media type": {"schema", "example", "examples", "encoding"},
    "example": {"summary", "description", "value", "externalValue"},
}


class Lint:
    def __init__(self, document):
        self.document = document
        self.faults = []
        self.resolver = jsonschema.RefResolver("", document)
        self.operation_ids = {}
        self.shapes = {}

    def fault(self, at, text):
        self.faults.append(f"{at}: {text}")

    def fields(self, kind, value, at, required=()):
        """Whether the object of this kind can be looked at further."""
        if not isinstance(value, dict):
            self.fault(at, f"a {kind} must be an object")
            return False
        for key in value:
            if key not in FIELDS[kind] and not key.startswith("x-"):
                self.fault(at, f"\"{key}\" is no field of the {kind}")
        for key in required:
            if key not in value:
                self.fault(at, f"a {kind} must have \"{key}\"")
        return True

    def check(self):
        d = self.document
        if not self.fields("document", d, "/", ("openapi", "info", "paths", "servers", "security")):
            return self.faults
        if not re.fullmatch(r"3\.1\.\d+", str(d.get("openapi"))):
            self.fault("/openapi", "must be 3.1.x")
        self.fields("info", d.get("info"), "/info", ("title", "version", "license"))
        self.references(d, "")
        if self.faults:  # what follows walks along references
            return self.faults
        for path, item in d["paths"].items():
            self.path(path, item)
        used = set(re.findall(r'"#/components/schemas/([^"/]+)"', json.dumps(d)))
        for name, schema in d.get("components", {}).get("schemas", {}).items():
            self.schema(schema, f"/components/schemas/{name}")
            if name not in used:
                self.fault(f"/components/schemas/{name}", "nothing refers to it")
        return self.faults

    def references(self, value, at):
        if isinstance(value, list):
            for i, one in enumerate(value):
                self.references(one, f"{at}/{i}")
        if not isinstance(value, dict):
            return
        if "externalValue" in value:
            self.fault(at, "an example must be in the document: externalValue leads out of the document")
        target = value.get("$ref")
        if isinstance(target, str):
            if not target.startswith("#/"):
                self.fault(at, f"{target} leads out of the document")
            else:
                try:
                    self.resolver.resolve(target)
                except jsonschema.RefResolutionError:
                    self.fault(at, f"{target} leads nowhere")
        for key, one in value.items():
            self.references(one, f"{at}/{key.replace('~', '~0').replace('/', '~1')}")

    def path(self, path, item):
        if not path.startswith("/"):
            self.fault(path, "a path must begin with a slash")
        shape = re.sub(r"\{[^}]*\}", "{}", path)
        if shape in self.shapes:
            self.fault(path, f"can't be told from {self.shapes[shape]}")
        self.shapes[shape] = path
        if not self.fields("path", item, path):
            return
        for method in METHODS & set(item):
            self.operation(path, method, item)

    def operation(self, path, method, item):
        at = f"{method} {path}"
        operation = item[method]
        if not self.fields("operation", operation, at, ("operationId", "summary", "responses")):
            return
        name = operation.get("operationId", "")
        if not re.fullmatch(r"[a-z][a-z0-9_]*", name):
            self.fault(at, f"operationId \"{name}\" is no name for a function")
        if name in self.operation_ids:
            self.fault(at, f"operationId {name} is that of {self.operation_ids[name]} too")
        self.operation_ids[name] = at
        self.parameters(path, item.get("parameters", []) + operation.get("parameters", []), at)
        if method in ("get", "delete", "head") and "requestBody" in operation:
            self.fault(at, "must not have a body")
        if "requestBody" in operation and self.fields("request body", operation["requestBody"], at, ("content",)):
            self.content(operation["requestBody"].get("content", {}), f"{at} request")
        responses = operation.get("responses", {})
        if not any(code.startswith("2") for code in responses):
            self.fault(at, "must say what success is")
        for code, response in responses.items():
            if not re.fullmatch(r"[1-5](\d\d|XX)|default", code):
                self.fault(at, f"{code} is no status")
            self.response(response, f"{at} {code}")

    def parameters(self, path, parameters, at):
        seen = set()
        for parameter in parameters:
            if set(parameter) == {"$ref"}:
                parameter = self.resolver.resolve(parameter["$ref"])[1]
            if not self.fields("parameter", parameter, at, ("name", "in", "schema")):
                continue
            key = (parameter.get("in"), parameter.get("name"))
            if key in seen:
                self.fault(at, f"parameter {key[1]} is declared twice")
            seen.add(key)
            if key[0] not in ("path", "query", "header", "cookie"):
                self.fault(at, f"parameter {key[1]}: in \"{key[0]}\" is no place")
            if key[0] == "path" and parameter.get("required") is not True:
                self.fault(at, f"parameter {key[1]} of the path must be required")
            self.schema(parameter.get("schema", {}), f"{at} {key[1]}")
        declared = {name for place, name in seen if place == "path"}
        for name in set(re.findall(r"\{([^}]*)\}", path)) ^ declared:
            self.fault(at, f"parameter {name} of the path is declared or used, not both")

    def response(self, response, at):
        if not self.fields("response", response, at, ("description",)):
            return
        for name, header in response.get("headers", {}).items():
            if self.fields("header", header, f"{at} {name}", ("schema",)):
                self.schema(header.get("schema", {}), f"{at} {name}")
        self.content(response.get("content", {}), at)

    def content(self, content, at):
        for name, media in content.items():
            at_media = f"{at} {name}"
            if not re.fullmatch(r"[a-z]+/[a-z0-9.+-]+", name):
                self.fault(at_media, "is no media type")
            if not self.fields("media type", media, at_media, ("schema",)):
                continue
            self.schema(media.get("schema", {}), at_media)
            for key, example in media.get("examples", {}).items():
                if self.fields("example", example, f"{at_media} {key}", ("summary", "value")):
                    self.fits(media.get("schema", {}), example.get("value"), f"{at_media} example {key}")

    def schema(self, schema, at):
        try:
            jsonschema.Draft202012Validator.check_schema(schema)
        except jsonschema.SchemaError as error:
            return self.fault(at, f"no JSON schema: {error.message[:200]}")
        self.within(schema, at)

    def within(self, schema, at):
        """Keys that are required exist, defaults fit, patterns compile: in the schema and all below it."""
        if not isinstance(schema, dict):
            return
        properties = schema.get("properties", {})
        if schema.get("additionalProperties") is False:
            for key in set(schema.get("required", [])) - set(properties):
                self.fault(at, f"{key} is required and not described")
        if "x-default" in schema:
            self.fits({k: v for k, v in schema.items() if k != "x-default"}, schema["x-default"], f"{at} x-default")
        for key, one in properties.items():
            if isinstance(one, dict) and "default" in one:
                self.fault(f"{at}/{key}", "default makes the key required in what is generated of this document: say x-default")
        if "pattern" in schema:
            try:
                re.compile(schema["pattern"])
            except re.error as error:
                self.fault(at, f"pattern {schema['pattern']}: {error}")
        for key, one in properties.items():
            self.within(one, f"{at}/{key}")
        for key in ("items", "additionalProperties", "not"):
            self.within(schema.get(key), f"{at}/{key}")
        for key in ("oneOf", "anyOf", "allOf", "prefixItems"):
            for i, one in enumerate(schema.get(key, [])):
                self.within(one, f"{at}/{key}/{i}")

    def fits(self, schema, value, at):
        validator = jsonschema.Draft202012Validator(schema, resolver=self.resolver)
        for error in validator.iter_errors(value):
            self.fault(at, f"/{'/'.join(map(str, error.path))}: {error.message[:200]}")


def breakages(document):
    """Ways to break a sound document, each with words of the fault that must be found."""
    plans = lambda d: d["paths"]["/v1/plans"]["post"]
    job = lambda d: d["paths"]["/v1/jobs/{id}"]["get"]
    body = lambda d: plans(d)["requestBody"]["content"]["application/json"]
    example = lambda d: next(iter(body(d)["examples"].values()))
    schemas = lambda d: d["components"]["schemas"]

    def external(d):
        example(d)["externalValue"] = "examples/plan.json"

    def rename(d):
        plans(d)["operationId"] = job(d)["operationId"]

    def twin(d):
        d["paths"]["/v1/jobs/{job}"] = copy.deepcopy(d["paths"]["/v1/jobs/{id}"])

    return [
        (external, "leads out of the document"),
        (lambda d: body(d)["schema"].update({"$ref": "#/components/schemas/Nothing"}), "leads nowhere"),
        (lambda d: body(d)["schema"].update({"$ref": "plan.json"}), "leads out of the document"),
        (lambda d: example(d)["value"].update(routes="three"), "is not of type"),
        (lambda d: example(d)["value"].update(gaol=1), "gaol"),
        (lambda d: d["components"]["parameters"]["Priority"].update({"in": "body"}), "is no place"),
        (rename, "is that of"),
        (twin, "can't be told from"),
        (lambda d: job(d).update(parameters=[]), "declared or used, not both"),
        (lambda d: job(d)["parameters"][0].update(required=False), "must be required"),
        (lambda d: job(d)["responses"].pop("200"), "must say what success is"),
        (lambda d: job(d)["responses"]["200"].pop("description"), "must have \"description\""),
        (lambda d: job(d).update(requestbody={}), "is no field of the operation"),
        (lambda d: schemas(d)["Job"]["required"].append("colour"), "required and not described"),
        (lambda d: schemas(d)["Job"].update(type="objekt"), "no JSON schema"),
        (lambda d: schemas(d).update(Unused={"type": "object"}), "nothing refers to it"),
        (lambda d: schemas(d)["PlanRequest"]["properties"]["routes"].update({"x-default": 99}), "x-default"),
        (lambda d: schemas(d)["PlanRequest"]["properties"]["routes"].update(default=3), "say x-default"),
        (lambda d: d.pop("servers"), "must have \"servers\""),
    ]


def self_test(document):
    missed = 0
    for i, (spoil, words) in enumerate(breakages(document)):
        broken = copy.deepcopy(document)
        spoil(broken)
        faults = Lint(broken).check()
        if not any(words in fault for fault in faults):
            print(f"breakage {i} ({words}) was not found; found: {faults[:3]}")
            missed += 1
    return missed


def main():
    document = json.loads(pathlib.Path(sys.argv[-1]).read_text())
    if sys.argv[1] == "--self-test":
        return 1 if self_test(document) else 0
    faults = Lint(document).check()
    print("\n".join(faults) or f"{len(document['paths'])} paths without a fault")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
