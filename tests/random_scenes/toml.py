"""A scene as nested dictionaries and lists, and the same as TOML."""


def value_text(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(item) for item in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {value_text(item)}" for key, item in value.items()) + " }"
    return repr(value)


def is_table(value):
    return isinstance(value, dict)


def is_table_list(value):
    """Written as [[key]]; lists of keyframes stay within their table."""
    return isinstance(value, list) and value and all(is_table(item) for item in value) and "time" not in value[0]


def tables(scene, path, lines):
    for key, value in scene.items():
        if not is_table(value) and not is_table_list(value):
            lines.append(f"{key} = {value_text(value)}")
    for key, value in scene.items():
        name = ".".join(path + [key])
        if is_table(value):
            lines.append(f"\n[{name}]")
            tables(value, path + [key], lines)
        elif is_table_list(value):
            for item in value:
                lines.append(f"\n[[{name}]]")
                tables(item, path + [key], lines)


def toml_text(scene):
    lines = []
    tables(scene, [], lines)
    return "\n".join(lines).strip() + "\n"
